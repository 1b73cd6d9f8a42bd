/* A program around `run_six`: COUNT normals in given.bin of a FOLDER become made.bin and words.bin there.

       code FOLDER COUNT

   What it runs may be anybody's: it limits itself. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <unistd.h>

/* How many numbers a row has, given and made. */
#ifndef RUN_GIVEN
#define RUN_GIVEN 12
#define RUN_MADE 24
#endif

void run_six(size_t count, const float *given, float *made, uint32_t *words);

static void limit(int what, unsigned long long most) {
    struct rlimit now;
    if (getrlimit(what, &now)) return;
    now.rlim_cur = now.rlim_max == RLIM_INFINITY || now.rlim_max > most ? most : now.rlim_max;
    setrlimit(what, &now);
}

static void *read_all(const char *name, size_t bytes) {
    FILE *file = fopen(name, "rb");
    void *data = malloc(bytes ? bytes : 1);
    if (!file || !data || fread(data, 1, bytes, file) != bytes) exit(3);
    fclose(file);
    return data;
}

static void write_all(const char *name, const void *data, size_t bytes) {
    FILE *file = fopen(name, "wb");
    if (!file || fwrite(data, 1, bytes, file) != bytes || fclose(file)) exit(3);
}

int main(int words, char **word) {
    if (words != 3 || chdir(word[1])) return 3;
    size_t count = strtoul(word[2], NULL, 10);
#ifdef RUN_SECONDS
    limit(RLIMIT_CPU, RUN_SECONDS);
    limit(RLIMIT_DATA, RUN_MEMORY);
    limit(RLIMIT_FSIZE, RUN_FILE);
    limit(RLIMIT_CORE, 0);
#endif
    float *given = (float *)read_all("given.bin", count * RUN_GIVEN * sizeof *given);
    float *made = (float *)calloc(count * RUN_MADE + 1, sizeof *made);
    uint32_t *packed = (uint32_t *)calloc(count * 4 + 1, sizeof *packed);
    if (!made || !packed) return 3;
    run_six(count, given, made, packed);
    write_all("made.bin", made, count * RUN_MADE * sizeof *made);
    write_all("words.bin", packed, count * 4 * sizeof *packed);
    free(given), free(made), free(packed);
    return 0;
}
