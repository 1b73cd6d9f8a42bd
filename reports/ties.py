"""The difference up to which neither of two figures counts as better: the same in sentences and in plots."""

TIE_DB = 0.05
