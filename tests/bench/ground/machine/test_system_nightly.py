"""The user's home folder, which the program needs before anything else."""

from test_system_slow import check_served


def test_doctor_works_for_a_user_without_a_home(tmp_path):
    check_served(tmp_path, ["doctor"])
