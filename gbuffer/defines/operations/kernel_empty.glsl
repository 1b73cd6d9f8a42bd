// The operation that does nothing: what is made is what was given, as many numbers as are wanted of it.

MADE kernel_operation(GIVEN given, BESIDE beside) {
    MADE made;
    for (int i = 0; i < made.length(); ++i) made[i] = given[i % given.length()];
    return made;
}
