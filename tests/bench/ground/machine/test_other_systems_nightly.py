"""Commands on macOS; the daily tests cover Windows."""

import test_other_systems_slow


def test_commands_succeed_on_macos_and_a_users_encoder_is_measured(tmp_path):
    test_other_systems_slow.test_commands_succeed_and_a_users_encoder_is_measured(tmp_path, "darwin")
