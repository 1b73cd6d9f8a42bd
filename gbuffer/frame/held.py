"""A resource on the device."""

from __future__ import annotations

from contextlib import ExitStack
from typing import Any

from ...encodings.storages.storage import Storage
from ..gl.device import Device
from ..gl.raw import depth_stencil
from .plan import Plan
from .resource import DEPTH_MAP, Resource, Texel


class Held:
    """A resource's copies, created on first use and released with the stack; one copy at a time is current."""

    def __init__(self, device: Device, stack: ExitStack, resource: Resource, plan: Plan):
        self._device, self._stack, self._resource = device, stack, resource
        self._texels, self._shape = resource.texels(plan), resource.shape(plan)
        self._copies: dict[int, list[Any]] = {}
        self._used = 0

    def copy(self, before: int) -> list[Any]:
        """Return the textures of the current copy, or of the copy that is `before` steps before it, created on first
        use. Depth with stencil is one `DepthBuffer`."""
        place = (self._used - before) % self._resource.copies
        if place not in self._copies:
            self._copies[place] = [self._owned_texture(texel) for texel in self._texels]
        return self._copies[place]

    def move_on(self) -> None:
        """Make the next copy the current copy; the last copy is followed by the first."""
        self._used = (self._used + 1) % self._resource.copies

    def _owned_texture(self, texel: Texel) -> Any:
        texture = self._new_texture(texel)
        self._stack.callback(texture.release)
        if self._resource.smooth:
            self._device.smooth(texture)
        return texture

    def _new_texture(self, texel: Texel) -> Any:
        width, height, samples = self._shape
        if isinstance(texel, Storage):
            volume = (width, height, self._resource.depth)
            volumes, flat = self._device.volume, self._device.target
            return volumes(volume, texel) if self._resource.depth else flat((width, height), texel, samples)
        if texel == DEPTH_MAP:
            return self._device.depth_map((width, height))
        return depth_stencil(self._device.context, (width, height), samples)
