"""The difference below which two figures count as equal, the same in sentences and in plots."""

TIE_DB = 0.05
