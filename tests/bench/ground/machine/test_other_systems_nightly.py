"""Commands on macOS, as on Windows by day."""

import test_other_systems_slow


def test_commands_end_well_on_macos_and_a_users_encoder_is_measured(tmp_path):
    test_other_systems_slow.test_commands_end_well_and_a_users_encoder_is_measured(tmp_path, "darwin")
