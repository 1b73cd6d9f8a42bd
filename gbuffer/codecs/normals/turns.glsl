// Loops that are counted: `turn` stands around the condition of each, and stops one that goes on and on.
uint turns[LOOPS];
bool endless;

void count_anew() {
    endless = false;
    for (int i = 0; i < LOOPS; i++) turns[i] = 0u;
}

bool turn(int loop, bool condition) {
    turns[loop] = condition ? turns[loop] + 1u : 0u;
    if (turns[loop] <= uint(MOST_TURNS)) return condition;
    endless = true;
    return false;
}
