static const float scaled_rg32f_steps[2][2] = {{3.0f, 0.5f}, {5.0f, 0.25f}};
