"""How close two figures may be before one of them counts as better: the same in sentences and in plots."""

TIE_DB = 0.05
