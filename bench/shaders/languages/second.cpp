
// The program around what Slang's compiler made of the shader above: COUNT normals in given.bin become made.bin.
#include <cstdio>
#include <cstdlib>

int main(int, char **word) {
    size_t count = strtoul(word[1], nullptr, 10);
    auto *given = (Vector<float, 4> *)calloc(3 * count, sizeof(Vector<float, 4>));
    auto *made = (Vector<float, 4> *)calloc(2 * count, sizeof(Vector<float, 4>));
    FILE *file = fopen("given.bin", "rb");
    if (!given || !made || !file || fread(given, sizeof *given, 3 * count, file) != 3 * count) return 3;
    GlobalParams_0 globals = {};
    globals.normalbench_given_0.data = given, globals.normalbench_given_0.count = 3 * count;
    globals.normalbench_made_0.data = made, globals.normalbench_made_0.count = 2 * count;
    ComputeVaryingInput groups = {};
    groups.endGroupID.x = (uint32_t)count, groups.endGroupID.y = groups.endGroupID.z = 1;
    normalbench_second(&groups, nullptr, &globals);
    file = fopen("made.bin", "wb");
    return !file || fwrite(made, sizeof *made, 2 * count, file) != 2 * count || fclose(file) ? 3 : 0;
}
