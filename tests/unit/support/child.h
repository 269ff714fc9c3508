/* A job in a process of its own: for what ends the program. Include after cmocka.h. */
#ifndef RG_CHILD_H
#define RG_CHILD_H

#include <stddef.h>
#include <sys/wait.h>
#include <unistd.h>

/* Runs `job` in a child process, which a minute ends; returns its exit status (1000 + the signal that killed
 * it) and what it said on standard error. */
static int run_child(void (*job)(void), char *said, size_t size) {
    int ends[2], status;
    assert_int_equal(pipe(ends), 0);
    pid_t child = fork();
    if (child == 0) {
        alarm(60);
        dup2(ends[1], STDERR_FILENO);
        job();
        _exit(0);
    }
    close(ends[1]);
    size_t length = 0;
    ssize_t got;
    while ((got = read(ends[0], said + length, size - 1 - length)) > 0) {
        length += (size_t)got;
    }
    said[length] = '\0';
    close(ends[0]);
    assert_int_equal(waitpid(child, &status, 0), child);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
}

#endif
