"""A Mesa Vulkan driver, and its compiler's report on a shader.

No GPU is needed: RADV offers a null device for the family in RADV_FORCE_FAMILY, and Intel's drivers accept the null
device of null_i915.c. This runs in a child process (`child`), because drivers crash.
"""

from __future__ import annotations

import hashlib
import struct
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

from ...ground.machine.systems import system_files
from ...ground.machine.systems.people import how_to_install

EXTENSION = "VK_KHR_pipeline_executable_properties"
# Mesa's drivers, and what disassembles for RADV; the Vulkan loader is libvulkan.so.
DRIVERS = ("libvulkan_", "libLLVM")
# A word of what a disassembly is called: "Assembly", "GEN Assembly", "IR3 Assembly", "QPU (MESA_SHADER_FRAGMENT)".
LISTINGS = {"Assembly", "QPU"}
VULKAN_1_3 = 1 << 22 | 3 << 12
# What kernel.frag writes.
TARGETS = 3
# Of SPIR-V.
OP_CAPABILITY, FLOAT16 = 17, 9


class DriverError(Exception):
    """An operation that the driver cannot perform; the message is one line."""


class MissingDriverError(DriverError):
    """A component that is not installed; the one-line message names the package."""


def _vulkan_module() -> Any:
    try:
        return import_module("vulkan")
    except ImportError as error:
        raise MissingDriverError(f"no Vulkan bindings: {error}; install them (python -m pip install vulkan)") from error
    except OSError as error:
        raise MissingDriverError(
            f"no Vulkan loader: libvulkan.so.1 cannot be loaded; install it ({how_to_install('libvulkan1')})"
        ) from error


# Of a file's head that tells builds apart: an ELF file's build id, and the places and sizes of its parts.
HEAD = 4096


def loaded_files() -> dict[str, str]:
    """Return the fingerprints, by path, of the loaded driver files and of the LLVM library that the driver
    disassembles with; empty if the system does not report a process's loaded files.

    Raises:
        MissingDriverError: there is no Vulkan loader.
        DriverError: the loader accepts no driver.
    """
    _instance(_vulkan_module())
    return {path: fingerprint(Path(path)) for path in system_files.loaded() if Path(path).name.startswith(DRIVERS)}


def fingerprint(path: Path) -> str:
    """Return a library's fingerprint, by which builds can be told apart: its size and a hash of its first bytes."""
    with path.open("rb") as file:
        return f"{path.stat().st_size} {hashlib.sha256(file.read(HEAD)).hexdigest()}"


def _instance(vk: Any) -> Any:
    try:
        application = vk.VkApplicationInfo(apiVersion=VULKAN_1_3)
        return vk.vkCreateInstance(vk.VkInstanceCreateInfo(pApplicationInfo=application), None)
    except vk.VkError as error:
        raise DriverError(f"the Vulkan loader found no usable driver: {type(error).__name__}") from error


def uses_halves(code: bytes) -> bool:
    """Whether a SPIR-V module declares 16-bit float arithmetic in its capabilities, which come first."""
    words = struct.unpack(f"<{len(code) // 4}I", code)
    index = 5
    while index < len(words) and words[index] & 0xFFFF == OP_CAPABILITY:
        if words[index + 1] == FLOAT16:
            return True
        index += 2
    return False


class Compiler:
    """A logical device that compiles shaders and reports the results.

    Attributes:
        device: the driver's name for the device.
        version: Mesa's version.

    Raises:
        MissingDriverError: there is no Vulkan loader, or no driver.
        DriverError: the driver lacks a required feature.
    """

    def __init__(self):
        self._vk = vk = _vulkan_module()
        physical = self._physical_device()
        properties = vk.vkGetPhysicalDeviceProperties(physical)
        self.device = str(properties.deviceName)
        number = properties.driverVersion
        self.version = f"{number >> 22}.{number >> 12 & 0x3FF}.{number & 0xFFF}"
        extensions = {e.extensionName for e in vk.vkEnumerateDeviceExtensionProperties(physical, None)}
        if EXTENSION not in extensions:
            raise DriverError(f"{self.device} (Mesa {self.version}) lacks {EXTENSION}")
        self._has_halves = bool(self._half_features(physical).shaderFloat16)
        # Whether targets are stated by a render pass, for a driver that has nothing newer.
        self._has_passes = False
        self._device = self._logical_device(physical)
        self._layout = None

    def _physical_device(self) -> Any:
        vk = self._vk
        try:
            return vk.vkEnumeratePhysicalDevices(_instance(vk))[0]
        except (vk.VkError, IndexError) as error:
            raise DriverError(f"the Vulkan driver lists no devices: {type(error).__name__}") from error

    def _half_features(self, physical: Any) -> Any:
        """Return a physical device's features for 16-bit arithmetic."""
        vk = self._vk
        halves = vk.VkPhysicalDeviceShaderFloat16Int8Features()
        vk.vkGetPhysicalDeviceFeatures2(physical, vk.VkPhysicalDeviceFeatures2(pNext=halves))
        return halves

    def _logical_device(self, physical: Any) -> Any:
        vk = self._vk
        halves = vk.VkPhysicalDeviceShaderFloat16Int8Features(shaderFloat16=int(self._has_halves))
        tells = vk.VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR(pipelineExecutableInfo=1, pNext=halves)
        renders = vk.VkPhysicalDeviceDynamicRenderingFeatures(dynamicRendering=1, pNext=tells)
        queue = vk.VkDeviceQueueCreateInfo(queueFamilyIndex=0, pQueuePriorities=[1.0])

        def made(features: Any) -> Any:
            info = vk.VkDeviceCreateInfo(pNext=features, pQueueCreateInfos=[queue], ppEnabledExtensionNames=[EXTENSION])
            return vk.vkCreateDevice(physical, info, None)

        try:
            return made(renders)
        except vk.VkErrorFeatureNotPresent:
            self._has_passes = True
        except vk.VkError as error:
            raise DriverError(f"no logical device for {self.device}: {type(error).__name__}") from error
        try:
            return made(tells)
        except vk.VkError as error:
            raise DriverError(f"no logical device for {self.device}: {type(error).__name__}") from error

    def compile(self, stage: str, code: bytes, vertex: bytes, planes: int) -> list[dict[str, Any]]:
        """Compile a shader and return its kernels.

        Args:
            stage: "compute" or "fragment".
            code: the shader, as SPIR-V.
            vertex: the vertex shader that precedes a fragment shader, as SPIR-V.
            planes: the binding of the storage buffer; lower bindings are lookup tables.

        Returns:
            a kernel for each number of lanes that the driver compiles for: "simd_width", that number; "statistics",
            under the driver's own names; and "assembly", the disassembly, empty if the driver gives none.

        Raises:
            DriverError: the shader does not compile.
        """
        vk = self._vk
        if not self._has_halves and uses_halves(code):
            raise DriverError(f"{self.device} does not support 16-bit shader arithmetic")
        self._layout = self._layout or self._pipeline_layout(planes)
        try:
            pipeline = self._compute_pipeline(code) if stage == "compute" else self._graphics_pipeline(code, vertex)
            bit = vk.VK_SHADER_STAGE_COMPUTE_BIT if stage == "compute" else vk.VK_SHADER_STAGE_FRAGMENT_BIT
            kernels = [
                self._kernel(pipeline, i, width) for i, stages, width in self._executables(pipeline) if stages & bit
            ]
        except vk.VkError as error:
            raise DriverError(f"{self.device} cannot compile the shader: {type(error).__name__}") from error
        if not kernels:
            raise DriverError(f"{self.device} reports no {stage} kernel")
        return kernels

    def _kernel(self, pipeline: Any, index: int, width: int) -> dict[str, Any]:
        executable = self._vk.VkPipelineExecutableInfoKHR(pipeline=pipeline, executableIndex=index)
        statistics, assembly = dict(self._statistics(executable)), self._disassembly(executable)
        return {"simd_width": width, "statistics": statistics, "assembly": assembly}

    def _pipeline_layout(self, planes: int) -> Any:
        vk = self._vk
        kinds = [vk.VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER] * planes + [vk.VK_DESCRIPTOR_TYPE_STORAGE_BUFFER]
        bindings = [
            vk.VkDescriptorSetLayoutBinding(
                binding=i, descriptorType=kind, descriptorCount=1, stageFlags=vk.VK_SHADER_STAGE_ALL
            )
            for i, kind in enumerate(kinds)
        ]
        chosen = vk.vkCreateDescriptorSetLayout(
            self._device, vk.VkDescriptorSetLayoutCreateInfo(pBindings=bindings), None
        )
        return vk.vkCreatePipelineLayout(self._device, vk.VkPipelineLayoutCreateInfo(pSetLayouts=[chosen]), None)

    def _shader_stage(self, bit: int, code: bytes) -> Any:
        vk = self._vk
        module = vk.vkCreateShaderModule(
            self._device, vk.VkShaderModuleCreateInfo(codeSize=len(code), pCode=code), None
        )
        return vk.VkPipelineShaderStageCreateInfo(stage=bit, module=module, pName="main")

    @property
    def _capture_flags(self) -> int:
        vk = self._vk
        representations = vk.VK_PIPELINE_CREATE_CAPTURE_INTERNAL_REPRESENTATIONS_BIT_KHR
        return vk.VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR | representations

    def _compute_pipeline(self, code: bytes) -> Any:
        vk = self._vk
        stage = self._shader_stage(vk.VK_SHADER_STAGE_COMPUTE_BIT, code)
        info = vk.VkComputePipelineCreateInfo(flags=self._capture_flags, stage=stage, layout=self._layout)
        return vk.vkCreateComputePipelines(self._device, None, 1, [info], None)[0]

    def _graphics_pipeline(self, code: bytes, vertex: bytes) -> Any:
        """Return a pipeline with a vertex shader, `vertex`, and a fragment shader, `code`. Its render targets are
        32-bit floats, so that it converts no numbers: a conversion counts towards the cost of the storage.

        Local variables keep each part until the call ends, because the bindings do not keep the members of a
        structure alive.
        """
        vk = self._vk
        stages = [self._shader_stage(vk.VK_SHADER_STAGE_VERTEX_BIT, vertex)]
        stages += [self._shader_stage(vk.VK_SHADER_STAGE_FRAGMENT_BIT, code)]
        formats = [vk.VK_FORMAT_R32G32B32A32_SFLOAT] * TARGETS
        targets = vk.VkPipelineRenderingCreateInfo(colorAttachmentCount=TARGETS, pColorAttachmentFormats=formats)
        render_pass = self._render_pass(formats) if self._has_passes else None
        attributes = vk.VkPipelineVertexInputStateCreateInfo()
        assembly = vk.VkPipelineInputAssemblyStateCreateInfo(topology=vk.VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST)
        ports, areas = [vk.VkViewport(0, 0, 1, 1, 0, 1)], [vk.VkRect2D(vk.VkOffset2D(0, 0), vk.VkExtent2D(1, 1))]
        viewport = vk.VkPipelineViewportStateCreateInfo(
            viewportCount=1, pViewports=ports, scissorCount=1, pScissors=areas
        )
        raster = vk.VkPipelineRasterizationStateCreateInfo(lineWidth=1.0)
        samples = vk.VkPipelineMultisampleStateCreateInfo(rasterizationSamples=1)
        blends = [vk.VkPipelineColorBlendAttachmentState(colorWriteMask=15)] * TARGETS
        blend = vk.VkPipelineColorBlendStateCreateInfo(
            attachmentCount=TARGETS, pAttachments=blends, blendConstants=[0, 0, 0, 0]
        )
        info = vk.VkGraphicsPipelineCreateInfo(
            pNext=None if self._has_passes else targets,
            renderPass=render_pass,
            flags=self._capture_flags,
            pStages=stages,
            pVertexInputState=attributes,
            pInputAssemblyState=assembly,
            pViewportState=viewport,
            pRasterizationState=raster,
            pMultisampleState=samples,
            pColorBlendState=blend,
            layout=self._layout,
        )
        return vk.vkCreateGraphicsPipelines(self._device, None, 1, [info], None)[0]

    def _render_pass(self, formats: list[int]) -> Any:
        """Return a render pass with colour attachments of these formats."""
        vk = self._vk
        layout = vk.VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL
        targets = [
            vk.VkAttachmentDescription(format=target_format, samples=1, finalLayout=layout) for target_format in formats
        ]
        drawn_to = [vk.VkAttachmentReference(attachment=i, layout=layout) for i in range(len(formats))]
        parts = [vk.VkSubpassDescription(colorAttachmentCount=len(drawn_to), pColorAttachments=drawn_to)]
        return vk.vkCreateRenderPass(
            self._device, vk.VkRenderPassCreateInfo(pAttachments=targets, pSubpasses=parts), None
        )

    def _executables(self, pipeline: Any) -> Iterator[tuple[int, int, int]]:
        """Return the index, stage flags and number of lanes of each executable in a pipeline."""
        ask = self._vk.vkGetDeviceProcAddr(self._device, "vkGetPipelineExecutablePropertiesKHR")
        executables = ask(self._device, self._vk.VkPipelineInfoKHR(pipeline=pipeline))
        return ((i, executable.stages, executable.subgroupSize) for i, executable in enumerate(executables))

    def _statistics(self, executable: Any) -> Iterator[tuple[str, float]]:
        vk = self._vk
        fields = ("b32", "i64", "u64", "f64")  # in the order of VkPipelineExecutableStatisticFormatKHR
        for statistic in vk.vkGetDeviceProcAddr(self._device, "vkGetPipelineExecutableStatisticsKHR")(
            self._device, executable
        ):
            yield str(statistic.name), getattr(statistic.value, fields[statistic.format])

    def _disassembly(self, executable: Any) -> str:
        """Return an executable's disassembly; empty if the driver gives none. The driver is called directly, because
        the bindings cannot pass the buffers for the text."""
        vk, ffi = self._vk, self._vk.ffi
        name = "vkGetPipelineExecutableInternalRepresentationsKHR"
        ask = ffi.cast(f"PFN_{name}", vk.lib.vkGetDeviceProcAddr(self._device, name.encode()))
        count, which = ffi.new("uint32_t*"), ffi.addressof(executable)
        ask(self._device, which, count, ffi.NULL)
        representations = ffi.new("VkPipelineExecutableInternalRepresentationKHR[]", count[0])
        for representation in representations:
            representation.sType = vk.VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INTERNAL_REPRESENTATION_KHR
        ask(self._device, which, count, representations)
        texts = [ffi.new("char[]", max(entry.dataSize, 1)) for entry in representations]
        for representation, text in zip(representations, texts, strict=True):
            representation.pData = text
        ask(self._device, which, count, representations)
        names = [ffi.string(entry.name).decode().split() for entry in representations]
        listing = next((text for name, text in zip(names, texts, strict=True) if LISTINGS & {*name}), None)
        return ffi.string(listing).decode(errors="replace") if listing is not None else ""
