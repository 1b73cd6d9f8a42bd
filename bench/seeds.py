"""The figures this project was measured against first.

A. Pranckevicius, Compact Normal Storage for Small G-Buffers, 2010: PSNR in dB of the 8-bit difference image over every
pixel, normals in RGBA8. The page's own summary prints 18.629 for X and Y; 18.692 is what its text and its MSE say.
"""

PSNR_DB = {
    "xyz": 51.081,
    "xy": 18.692,
    "spherical": 42.042,
    "spheremap": 48.071,
    "stereographic": 44.147,
    "per_pixel_view": 38.730,
}
NORMALS, STORAGE = "playground", "rgba8"
