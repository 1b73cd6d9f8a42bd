// Whether the device still makes turns. A software driver ends all loops of a shader together, after 65535 turns, and
// goes on with what it has: behind an encoder whose loops it has ended, this loop is ended at once too.
uniform int asked_turns;

int turns_made() {
    int made = 0;
    for (int i = 0; i < asked_turns; ++i) made += 1;
    return made;
}
