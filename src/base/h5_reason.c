#include "base/h5_reason.h"

#include <stdio.h>
#include <string.h>

/* Of a call of the system HDF5 tells the time, the address of the buffer and more; its message says it. */
static herr_t copy_description(unsigned n, const H5E_error2_t *error, void *reason) {
    static const char mark[] = "error message = '";
    (void)n;
    const char *message = strstr(error->desc, mark);
    const char *text = message != NULL ? message + strlen(mark) : error->desc;
    int length = message != NULL ? (int)strcspn(text, "'") : RG_H5_REASON;
    snprintf(reason, RG_H5_REASON, "%.*s", length, text);
    return 1; /* enough: the innermost entry of the error stack is the cause */
}

static herr_t record(hid_t stack, void *reason) {
    (void)stack; /* the default one */
    if (*(char *)reason == '\0') {
        H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, copy_description, reason);
    }
    return 0;
}

void rg_h5_listen(char *reason) {
    H5Eset_auto2(H5E_DEFAULT, record, reason);
}

void rg_h5_deafen(void) {
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
}
