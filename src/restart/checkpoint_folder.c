#include "restart/checkpoint_folder.h"

#include <dirent.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/h5_parallel.h"
#include "base/mem.h"

static int newest_first(const void *a, const void *b) {
    int64_t p = *(const int64_t *)a, q = *(const int64_t *)b;
    return (p < q) - (p > q);
}

/* The step of a file name, or -1 if it is not that of a checkpoint. */
static int64_t step_of(const char *name) {
    int64_t step = -1;
    char again[64];
    if (sscanf(name, "step-%" SCNd64 ".h5", &step) != 1 || step < 0) {
        return -1;
    }
    snprintf(again, sizeof again, "step-%012" PRId64 ".h5", step);
    return strcmp(again, name) == 0 ? step : -1;
}

int rg_folder_list(const char *folder, int64_t **steps) {
    int count = 0;
    *steps = NULL;
    DIR *dir = opendir(folder);
    for (struct dirent *e = dir == NULL ? NULL : readdir(dir); e != NULL; e = readdir(dir)) {
        int64_t step = step_of(e->d_name);
        if (step >= 0) {
            *steps = rg_realloc(*steps, (size_t)count + 1, sizeof **steps);
            (*steps)[count++] = step;
        }
    }
    if (dir != NULL) {
        closedir(dir);
    }
    if (*steps != NULL) {
        qsort(*steps, (size_t)count, sizeof **steps, newest_first);
    }
    return count;
}

char *rg_folder_path(const char *folder, int64_t step) {
    char name[64];
    snprintf(name, sizeof name, "step-%012" PRId64 ".h5", step);
    return rg_join_path(folder, name);
}

void rg_folder_clean(const char *folder) {
    DIR *dir = opendir(folder);
    for (struct dirent *e = dir == NULL ? NULL : readdir(dir); e != NULL; e = readdir(dir)) {
        size_t n = strlen(e->d_name);
        if (strncmp(e->d_name, "step-", 5) == 0 && n > 5 && strcmp(e->d_name + n - 5, ".part") == 0) {
            char *path = rg_join_path(folder, e->d_name);
            unlink(path);
            rg_free(path);
        }
    }
    if (dir != NULL) {
        closedir(dir);
    }
}

void rg_folder_prune(const char *folder, int keep) {
    int64_t *steps;
    int count = rg_folder_list(folder, &steps);
    for (int i = keep; i < count; i++) {
        char *path = rg_folder_path(folder, steps[i]);
        unlink(path);
        rg_free(path);
    }
    rg_free(steps);
}
