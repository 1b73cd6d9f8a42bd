"""The published figures that this project was first compared with.

A. Pranckevicius, Compact Normal Storage for Small G-Buffers, 2010.

Quality: PSNR in dB of the 8-bit difference image over every pixel, normals in RGBA8. The page's own summary prints
18.629 for X and Y; its text and its MSE give 18.692.

Cost: HLSL compiled to ps_3_0 by d3dx9_42 (February 2010), instruction slots for arithmetic and texture reads,
including scale and bias for UNORM; general purpose registers and cycles per pixel, on Radeons by GPU ShaderAnalyzer
1.53 (Catalyst 9.12) and on GeForces by NVShaderPerf 2.0 (174.74). The page's own summary prints 1.00 cycles to decode
stereographic on the Radeon HD 5870; its text gives 0.50.
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
# Whose pictures come first: the article's methods, and the one that most people use today.
PICTURED = (*PSNR_DB, "octahedral")

SLOTS_BY = "ps_3_0 by d3dx9_42"
RADEONS, GEFORCES = "GPU ShaderAnalyzer 1.53, Catalyst 9.12", "NVShaderPerf 2.0, 174.74"
GPUS = {
    "Radeon HD 2400": RADEONS,
    "Radeon HD 3870": RADEONS,
    "Radeon HD 5870": RADEONS,
    "GeForce 6200": GEFORCES,
    "GeForce 7800GT": GEFORCES,
    "GeForce 8800GTX": GEFORCES,
}
# (arithmetic, texture) slots of an encoding's operation.
SLOTS = {
    ("xyz", "encode"): (1, 0),
    ("xyz", "decode"): (2, 1),
    ("xy", "encode"): (1, 0),
    ("xy", "decode"): (7, 1),
    ("spherical", "encode"): (26, 0),
    ("spherical", "decode"): (17, 1),
    ("spheremap", "encode"): (4, 0),
    ("spheremap", "decode"): (8, 1),
    ("stereographic", "encode"): (5, 0),
    ("stereographic", "decode"): (7, 1),
    ("per_pixel_view", "encode"): (17, 0),
    ("per_pixel_view", "decode"): (21, 1),
}
# (registers, cycles) in the order of GPUS.
CYCLES = {
    ("xyz", "encode"): ((1, 1.0), (1, 1.0), (1, 0.5), (1, 1.0), (1, 1.0), (6, 8.0)),
    ("xyz", "decode"): ((1, 1.0), (1, 1.0), (1, 0.5), (1, 1.0), (1, 1.0), (6, 10.0)),
    ("xy", "encode"): ((1, 1.0), (1, 1.0), (1, 0.5), (1, 1.0), (1, 1.0), (5, 7.0)),
    ("xy", "decode"): ((1, 1.0), (1, 1.0), (1, 0.5), (1, 4.0), (1, 3.0), (5, 15.0)),
    ("spherical", "encode"): ((1, 17.0), (1, 4.25), (2, 0.95), (2, 12.0), (2, 9.0), (9, 43.0)),
    ("spherical", "decode"): ((1, 17.0), (1, 4.25), (2, 0.95), (2, 7.0), (1, 5.0), (6, 23.0)),
    ("spheremap", "encode"): ((2, 3.0), (2, 1.0), (2, 0.5), (1, 4.0), (1, 2.0), (5, 12.0)),
    ("spheremap", "decode"): ((2, 3.0), (2, 1.0), (2, 0.5), (1, 6.0), (1, 3.0), (6, 15.0)),
    ("stereographic", "encode"): ((2, 4.0), (2, 1.0), (2, 0.5), (1, 2.0), (1, 2.0), (5, 12.0)),
    ("stereographic", "decode"): ((2, 4.0), (2, 1.0), (2, 0.5), (1, 4.0), (1, 4.0), (6, 12.0)),
    ("per_pixel_view", "encode"): ((3, 11.0), (3, 2.75), (2, 0.8), (4, 12.0), (4, 8.0), (8, 24.0)),
    ("per_pixel_view", "decode"): ((3, 11.0), (3, 2.75), (2, 0.8), (3, 12.0), (3, 9.0), (12, 29.0)),
}
# A. Pranckevicius, Compact Normal Storage for Small G-Buffers (Old and Wrong), 2009: instructions of SM3.0 by d3dx9_40
# (November 2008). Its decoders are counted without the read of the G-buffer.
SLOTS_2009 = {
    ("xy", "encode"): 1,
    ("xy", "decode"): 6,
    ("spherical", "encode"): 26,
    ("spherical", "decode"): 10,
    ("spherical_lut", "encode"): 4,
    ("spherical_lut", "decode"): 3,
    ("spheremap_classic", "encode"): 7,
    ("spheremap_classic", "decode"): 8,
    ("cryengine3", "encode"): 9,
    ("cryengine3", "decode"): 7,
    ("spheremap", "encode"): 4,
    ("spheremap", "decode"): 7,
    ("stereographic", "encode"): 5,
    ("stereographic", "decode"): 7,
}
