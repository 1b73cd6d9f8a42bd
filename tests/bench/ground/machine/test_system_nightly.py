"""What the program needs of a user before anything else is used."""

from test_system_slow import check_served


def test_doctor_serves_a_user_without_a_home(tmp_path):
    check_served(tmp_path, ["doctor"])
