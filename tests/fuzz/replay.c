/* Runs a fuzz target on the files that are named, and on those in directories that are named: where there is
 * no libFuzzer. */
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "host.h"

static int tried;

static void try_file(const char *path) {
    FILE *f = fopen(path, "rb");
    if (f == NULL) {
        perror(path);
        exit(1);
    }
    size_t room = 1 << 20, size = 0;
    uint8_t *data = malloc(room);
    size = data == NULL ? 0 : fread(data, 1, room, f);
    fclose(f);
    uint8_t *exact = malloc(size + (size == 0)); /* so that a step beyond the end is seen */
    if (exact == NULL || data == NULL) {
        exit(1);
    }
    memcpy(exact, data, size);
    free(data);
    fprintf(stderr, "%s\n", path); /* the last one is to blame */
    LLVMFuzzerTestOneInput(exact, size);
    free(exact);
    tried++;
}

static void try_all(const char *path) {
    struct stat about;
    struct dirent **entry;
    if (stat(path, &about) != 0) {
        perror(path);
        exit(1);
    }
    if (!S_ISDIR(about.st_mode)) {
        try_file(path);
        return;
    }
    int entries = scandir(path, &entry, NULL, alphasort);
    for (int i = 0; i < entries; i++) {
        char inner[4096];
        snprintf(inner, sizeof inner, "%s/%s", path, entry[i]->d_name);
        if (entry[i]->d_name[0] != '.') {
            try_all(inner);
        }
        free(entry[i]);
    }
    free(entry);
}

int main(int argc, char **argv) {
    LLVMFuzzerInitialize(&argc, &argv);
    for (int i = 1; i < argc; i++) {
        try_all(argv[i]);
    }
    printf("%d inputs\n", tried);
    return tried > 0 ? 0 : 1;
}
