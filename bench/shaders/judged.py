"""Texts generated from encoders, in a form that may be passed to compilers."""

from __future__ import annotations

from ...gbuffer.gl.shader import ShaderError, Source
from ..ground.compilers.lines import bare, with_known_directives
from ..ground.compilers.text import RULES, RefusedError, Text, judged


def judged_text(text: str, language: str, source: Source | None = None) -> Text:
    """Return a text generated from an encoder, without its comments, for compilers of a language.

    Args:
        source: the text as lines that come from several files.

    Raises:
        ShaderError: the text must not be passed to a compiler; the message has the file and the line.
    """
    whole = with_known_directives(bare(text, is_wgsl=language == "wgsl"), RULES[language].heads)
    try:
        return judged(whole, language)
    except RefusedError as error:
        message = f"0:{error.line}: {error.why}"
        raise ShaderError(source.explain(message) if source else message) from error
