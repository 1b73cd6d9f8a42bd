"""JSON and TOML files from users: numbers that are not finite are refused, and the message says where they are."""

import pytest

from normalbench.encodings.codecs.files import file_toml, parsed_json

TOO_LARGE = ("9" * 310, "-" + "9" * 310, "9" * 5000, "1e999", "-1e999")
JSON = (*TOO_LARGE, "NaN", "Infinity", "-Infinity")
TOML = ("9" * 310, "1e999", "nan", "-inf", "0x" + "f" * 257, "0b" + "1" * 1025)


@pytest.mark.parametrize("number", JSON)
def test_json_error_locates_a_number_that_is_not_finite(number):
    with pytest.raises(ValueError) as refusal:
        parsed_json(f'{{"a": [1, {{"b c": {number}}}], "d": 2}}')
    assert str(refusal.value) == "a[1].b c is not a finite number; write one below 1e308", number[:20]


@pytest.mark.parametrize("number", TOML)
def test_toml_error_locates_a_number_that_is_not_finite(number, tmp_path):
    path = tmp_path / "a.toml"
    path.write_text(f"[[gate]]\nx = 1\n[[gate]]\nx = {number}\n")
    with pytest.raises(ValueError) as refusal:
        file_toml(path)
    assert str(refusal.value) == "gate[1].x is not a finite number; write one below 1e308", number[:20]


@pytest.mark.parametrize("digits", ["9" * 5000, "-" + "9_9" * 5000])
def test_toml_error_gives_the_line_of_a_number_with_too_many_digits(digits, tmp_path):
    path = tmp_path / "a.toml"
    path.write_text(f"x = 1\ny = [\n{digits}]\n")
    with pytest.raises(ValueError) as refusal:
        file_toml(path)
    assert str(refusal.value) == "line 3: a number has too many digits; write a smaller one"


@pytest.mark.parametrize(
    "text, number", [("9" * 308, int("9" * 308)), ("1e308", 1e308), ("-0", 0), ("1e-400", 0.0), ("true", True)]
)
def test_json_keeps_numbers_that_fit_in_a_float(text, number):
    assert parsed_json(text) == number


def test_a_long_name_is_shortened_in_the_message():
    with pytest.raises(ValueError) as refusal:
        parsed_json(f'{{"{"n" * 100_000}": NaN}}')
    assert len(str(refusal.value)) < 260


@pytest.mark.parametrize("data, said", [(b"\xff", "it is not text in UTF-8"), ("[" * 9999, "it is nested too deep")])
def test_invalid_json_is_refused_with_the_reason(data, said):
    with pytest.raises(ValueError, match=said):
        parsed_json(data)
