"""Short names for devices and browsers, from the text that a browser reports.

A browser reports the GPU as text: the driver's own name or, on most systems, ANGLE's form, `ANGLE (vendor, GPU,
API)`. The short name leaves out the versions of the API and of the driver, unless devices would share it.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable

UNKNOWN_DEVICE, UNKNOWN_BROWSER = "unknown device", "unknown browser"
LONGEST = 48
ANGLE = re.compile(r"ANGLE \((.*)\)(.*)")
# Around and behind a GPU's name: what runs it, and the shader models of Direct3D.
BEFORE = re.compile(r"^(ANGLE \w+ Renderer: |Mesa |NVIDIA |AMD |ATI )+", re.IGNORECASE)
VULKAN = re.compile(r"Vulkan [\d.]+ \((.*)\)$")
BEHIND = re.compile(r"(/PCIe|/SSE|/integrated| Direct3D| OpenGL| on Vulkan).*$", re.IGNORECASE)
MARKS = re.compile(r"\((R|TM|C)\)", re.IGNORECASE)
INNERMOST = re.compile(r"\([^()]*\)")
APIS = re.compile(r"(Direct3D\d+|OpenGL ES|OpenGL|Vulkan|Metal)")
# By what a user agent says, the first that it has; those that call themselves another's name as well come first.
BROWSERS = (
    (r"Edg(?:A|iOS)?/(\d+)", "Edge"),
    (r"OPR/(\d+)", "Opera"),
    (r"SamsungBrowser/(\d+)", "Samsung Internet"),
    (r"(?:Firefox|FxiOS)/(\d+)", "Firefox"),
    (r"CriOS/(\d+)", "Chrome on iOS"),
    (r"(?:Chrom(?:e|ium)|HeadlessChrome)/(\d+)", "Chromium"),
    (r"Version/(\d+)[\d.]* .*Safari/", "Safari"),
)


def device_name(renderer: str) -> str:
    """Return a GPU's short name from the name of its renderer: `GeForce RTX 4090` from `ANGLE (NVIDIA, NVIDIA GeForce
    RTX 4090 Direct3D11 vs_5_0, D3D11)`."""
    wrapped = ANGLE.fullmatch(renderer.strip())
    parts = _comma_parts(wrapped[1]) if wrapped else [renderer]
    name = parts[1] if len(parts) > 1 else parts[0]
    similar = " or similar" if "or similar" in renderer else ""
    name = name.replace(", or similar", "").strip()
    if inner := VULKAN.match(name):
        name = inner[1]
    name = MARKS.sub("", name)
    while INNERMOST.search(name):
        name = INNERMOST.sub("", name)
    name = BEHIND.sub("", BEFORE.sub("", name)).strip().removesuffix(" Device")
    return (" ".join(name.split())[: LONGEST - len(similar)].rstrip(" ,") + similar).strip() or UNKNOWN_DEVICE


def _comma_parts(text: str) -> list[str]:
    """Return the parts of a text between commas; commas inside parentheses do not count."""
    parts, depth = [""], 0
    for letter in text:
        depth += {"(": 1, ")": -1}.get(letter, 0)
        if letter == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += letter
    return [part.strip() for part in parts]


def browser_name(agent: str) -> str:
    """Return a browser and its major version, such as `Firefox 153`, from its user agent; a shortened user agent if
    the browser is not known."""
    for pattern, name in BROWSERS:
        if match := re.search(pattern, agent):
            return f"{name} {match[1][:6]}"
    return " ".join(agent.split())[:LONGEST].strip() or UNKNOWN_BROWSER


def told_apart(renderers: Iterable[str]) -> dict[str, str]:
    """Return a unique short name for each renderer, whatever the order of the renderers.

    The API is appended to names that renderers share; if they share that too, four digits of a hash are appended.
    """
    every = sorted(set(renderers))
    short_names = {renderer: device_name(renderer) for renderer in every}
    for more in (_api_name, _renderer_hash):
        names = list(short_names.values())
        short_names = {
            r: f"{name} ({more(r)})" if names.count(name) > 1 and more(r) else name for r, name in short_names.items()
        }
    return short_names


def _api_name(renderer: str) -> str:
    # The last: ANGLE says it behind the GPU's name.
    return next(reversed(APIS.findall(renderer)), "")


def _renderer_hash(renderer: str) -> str:
    return hashlib.sha256(renderer.encode()).hexdigest()[:4]
