/* The end of a run by rg_fatal, before MPI begins, within it on one rank, and after it has ended. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>
#include <mpi.h>

#include "base/error.h"
#include "support/child.h"

static char said[4096];

static void before(void) {
    rg_warn("%s %d", "first", 1);
    rg_fatal(RG_USAGE, "%s %d", "then", 2);
}

static void within(void) {
    MPI_Init(NULL, NULL);
    rg_fatal(RG_INTERRUPTED, "within");
}

static void after(void) {
    MPI_Init(NULL, NULL);
    MPI_Finalize();
    rg_fatal(RG_INTERRUPTED, "after");
}

static void test_fatal(void **state) {
    (void)state;
    assert_int_equal(run_child(before, said, sizeof said), RG_USAGE);
    assert_string_equal(said, "rhegma: warning: first 1\nrhegma: then 2\n");
    assert_int_equal(run_child(within, said, sizeof said), RG_INTERRUPTED);
    assert_string_equal(said, "rhegma: within\n");
    assert_int_equal(run_child(after, said, sizeof said), RG_INTERRUPTED);
    assert_string_equal(said, "rhegma: after\n");
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_fatal)};
    return cmocka_run_group_tests_name("error", tests, NULL, NULL);
}
