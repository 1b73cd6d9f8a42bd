"""The published figures, as their sources print them."""

from __future__ import annotations

from . import buffers, codes, encoders
from .figure import Source

SOURCES = (
    Source("A. Pranckevicius, Compact Normal Storage for Small G-Buffers, 2010", encoders.PRANCKEVICIUS_2010),
    Source(
        "A. Pranckevicius, Compact Normal Storage for Small G-Buffers (Old and Wrong), 2009",
        encoders.PRANCKEVICIUS_2009,
    ),
    Source(
        "Z. Cigolle et al., A Survey of Efficient Representations for Independent Unit Vectors, 2014",
        encoders.CIGOLLE_2014,
    ),
    Source("L. Tyler, Analyzing Octahedral Encoded Normals, 2025", encoders.TYLER_2025),
    Source("J. Smith et al., Encoding Normal Vectors using Optimized Spherical Coordinates, 2012", codes.SMITH),
    Source("Q. Meyer et al., On Floating-Point Normal Vectors, 2010", codes.MEYER),
    Source("A. Kaplanyan, CryENGINE 3: Reaching the Speed of Light, 2010, as a forum retells it", codes.KAPLANYAN),
    Source("S. Hillaire, Crytek's Best Fit Normals, 2010", codes.HILLAIRE),
    Source("Unity, ScriptableRenderPipeline, 2017", codes.UNITY),
    Source("xeokit SDK, documentation", codes.XEOKIT),
    Source("normal_pack 0.1.4, 2024", codes.NORMAL_PACK),
    Source("M. Drobot, Architektury Deferred (slides)", buffers.DROBOT),
    Source("Jo Kyeong-jun, Advanced Rendering with Vision Engine (slides)", buffers.JO),
    Source("J. Ols, Linear sRGB Blending & Deferred Lighting, 2010", buffers.OLS_2010),
    Source("J. Ols, Prelighting & Log-Lights, 2009", buffers.OLS_2009),
    Source("EXT_texture_shared_exponent, 2004", buffers.SHARED_EXPONENT),
    Source("B. Kemen, Logarithmic Depth Buffer, 2009", buffers.KEMEN),
    Source("B. Kemen, Maximizing Depth Buffer Range and Precision, 2012", buffers.KEMEN_2012),
    Source("E. Golubev, Quantitative Analysis of Z-Buffer Precision, 2020", buffers.GOLUBEV),
)
