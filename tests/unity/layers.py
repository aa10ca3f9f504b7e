"""Draws into both layers of a target in one pass, as a headset's eyes are drawn: by multiview, or by instances.

Vulkan itself, by PyPI's bindings, because wgpu gives its passes no mask of views.
"""

from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from typing import Any

import numpy as np
import vulkan as vk

from mua.arrays import Array

LAYERS = 2
BOTH = 0b11  # mask of views
FORMAT = vk.VK_FORMAT_R32G32B32A32_SFLOAT
TEXEL_BYTES = 16
API = vk.VK_MAKE_VERSION(1, 1, 0)  # the first with multiview in its core
LAYER_OF_A_VERTEX = "VK_EXT_shader_viewport_index_layer"  # that a vertex shader may choose
STAGES = vk.VK_SHADER_STAGE_VERTEX_BIT | vk.VK_SHADER_STAGE_FRAGMENT_BIT
MAPPED = vk.VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | vk.VK_MEMORY_PROPERTY_HOST_COHERENT_BIT
COLOR = vk.VK_IMAGE_ASPECT_COLOR_BIT
KINDS = {True: vk.VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, False: vk.VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}
USAGES = {True: vk.VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, False: vk.VK_BUFFER_USAGE_STORAGE_BUFFER_BIT}


@dataclass(frozen=True)
class Bound:
    """What a shader reads at a binding."""

    group: int  # descriptor set
    binding: int
    uniform: bool  # else a storage buffer
    content: bytes


@dataclass(frozen=True)
class Stage:
    """SPIR-V and its entry point."""

    code: bytes
    entry: str


class LayeredDevice:
    """The first Vulkan device of this machine; a context manager that gives all back."""

    def __init__(self) -> None:
        self._made = ExitStack()
        application = vk.VkApplicationInfo(apiVersion=API)
        instance = vk.vkCreateInstance(vk.VkInstanceCreateInfo(pApplicationInfo=application), None)
        self._made.callback(vk.vkDestroyInstance, instance, None)
        self._physical = vk.vkEnumeratePhysicalDevices(instance)[0]
        queue = vk.VkDeviceQueueCreateInfo(queueFamilyIndex=0, queueCount=1, pQueuePriorities=[1.0])
        parameters = vk.VkPhysicalDeviceShaderDrawParametersFeatures(shaderDrawParameters=True)  # slangc's vertex ids
        features = vk.VkPhysicalDeviceMultiviewFeatures(pNext=parameters, multiview=True)
        asked = vk.VkDeviceCreateInfo(
            pNext=features, pQueueCreateInfos=[queue], ppEnabledExtensionNames=[LAYER_OF_A_VERTEX]
        )
        self._device = vk.vkCreateDevice(self._physical, asked, None)
        self._made.callback(vk.vkDestroyDevice, self._device, None)
        self._queue = vk.vkGetDeviceQueue(self._device, 0, 0)

    def __enter__(self) -> "LayeredDevice":
        return self

    def __exit__(self, *_: object) -> None:
        self._made.close()

    def draw(
        self,
        stages: tuple[Stage, Stage],  # vertex, fragment
        bound: Sequence[Bound],
        *,
        screen: tuple[int, int],
        vertices: int,
        instances: int,
        multiview: bool,
    ) -> Array:
        """[2, H, W, 4] of triangles laid over nothing as premultiplied colour; clip y points up."""
        image, view = self._target(screen)
        render_pass = self._pass(multiview)
        groups, layout = self._groups(bound)
        pipeline = self._pipeline(stages, layout, render_pass, screen)
        frame = self._make(
            "Framebuffer",
            renderPass=render_pass,
            pAttachments=[view],
            width=screen[0],
            height=screen[1],
            layers=1 if multiview else LAYERS,  # views of a pass count for one
        )
        size = LAYERS * screen[0] * screen[1] * TEXEL_BYTES
        read, memory = self._buffer(size, vk.VK_BUFFER_USAGE_TRANSFER_DST_BIT)

        def record(commands: Any) -> None:
            area = vk.VkRect2D(extent=vk.VkExtent2D(*screen))
            clear = vk.VkClearValue(color=vk.VkClearColorValue(float32=[0.0] * 4))
            begin = vk.VkRenderPassBeginInfo(
                renderPass=render_pass, framebuffer=frame, renderArea=area, pClearValues=[clear]
            )
            vk.vkCmdBeginRenderPass(commands, begin, vk.VK_SUBPASS_CONTENTS_INLINE)
            vk.vkCmdBindPipeline(commands, vk.VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline)
            vk.vkCmdBindDescriptorSets(
                commands, vk.VK_PIPELINE_BIND_POINT_GRAPHICS, layout, 0, len(groups), groups, 0, None
            )
            vk.vkCmdDraw(commands, vertices, instances, 0, 0)
            vk.vkCmdEndRenderPass(commands)
            layers = vk.VkImageSubresourceLayers(aspectMask=COLOR, layerCount=LAYERS)
            copy = vk.VkBufferImageCopy(imageSubresource=layers, imageExtent=vk.VkExtent3D(*screen, 1))
            vk.vkCmdCopyImageToBuffer(commands, image, vk.VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, read, 1, [copy])

        self._run(record)
        content = bytes(vk.vkMapMemory(self._device, memory, 0, size, 0))
        return np.frombuffer(content, np.float32).reshape(LAYERS, screen[1], screen[0], 4)

    def _make(self, kind: str, **fields: Any) -> Any:
        """vkCreate<kind>, destroyed with the device."""
        made = getattr(vk, f"vkCreate{kind}")(self._device, getattr(vk, f"Vk{kind}CreateInfo")(**fields), None)
        self._made.callback(getattr(vk, f"vkDestroy{kind}"), self._device, made, None)
        return made

    def _memory(self, needs: Any, wanted: int) -> Any:
        kinds = vk.vkGetPhysicalDeviceMemoryProperties(self._physical).memoryTypes
        index = next(
            i for i, kind in enumerate(kinds) if needs.memoryTypeBits >> i & 1 and kind.propertyFlags & wanted == wanted
        )
        asked = vk.VkMemoryAllocateInfo(allocationSize=needs.size, memoryTypeIndex=index)
        memory = vk.vkAllocateMemory(self._device, asked, None)
        self._made.callback(vk.vkFreeMemory, self._device, memory, None)
        return memory

    def _buffer(self, size: int, usage: int, content: bytes = b"") -> tuple[Any, Any]:
        buffer = self._make("Buffer", size=size, usage=usage)
        memory = self._memory(vk.vkGetBufferMemoryRequirements(self._device, buffer), MAPPED)
        vk.vkBindBufferMemory(self._device, buffer, memory, 0)
        if content:
            vk.vkMapMemory(self._device, memory, 0, size, 0)[: len(content)] = content
            vk.vkUnmapMemory(self._device, memory)
        return buffer, memory

    def _target(self, screen: tuple[int, int]) -> tuple[Any, Any]:
        image = self._make(
            "Image",
            imageType=vk.VK_IMAGE_TYPE_2D,
            format=FORMAT,
            extent=vk.VkExtent3D(*screen, 1),
            mipLevels=1,
            arrayLayers=LAYERS,
            samples=vk.VK_SAMPLE_COUNT_1_BIT,
            usage=vk.VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | vk.VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
        )
        memory = self._memory(vk.vkGetImageMemoryRequirements(self._device, image), 0)
        vk.vkBindImageMemory(self._device, image, memory, 0)
        whole = vk.VkImageSubresourceRange(aspectMask=COLOR, levelCount=1, layerCount=LAYERS)
        kind = vk.VK_IMAGE_VIEW_TYPE_2D_ARRAY
        return image, self._make("ImageView", image=image, viewType=kind, format=FORMAT, subresourceRange=whole)

    def _pass(self, multiview: bool) -> Any:
        color = vk.VkAttachmentDescription(
            format=FORMAT,
            samples=vk.VK_SAMPLE_COUNT_1_BIT,
            loadOp=vk.VK_ATTACHMENT_LOAD_OP_CLEAR,
            storeOp=vk.VK_ATTACHMENT_STORE_OP_STORE,
            finalLayout=vk.VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
        )
        used = vk.VkAttachmentReference(attachment=0, layout=vk.VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL)
        subpass = vk.VkSubpassDescription(pColorAttachments=[used])
        views = vk.VkRenderPassMultiviewCreateInfo(pViewMasks=[BOTH], pCorrelationMasks=[BOTH])
        copied = vk.VkSubpassDependency(
            srcSubpass=0,
            dstSubpass=vk.VK_SUBPASS_EXTERNAL,
            srcStageMask=vk.VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
            dstStageMask=vk.VK_PIPELINE_STAGE_TRANSFER_BIT,
            srcAccessMask=vk.VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
            dstAccessMask=vk.VK_ACCESS_TRANSFER_READ_BIT,
        )
        return self._make(
            "RenderPass",
            pNext=views if multiview else None,
            pAttachments=[color],
            pSubpasses=[subpass],
            pDependencies=[copied],
        )

    def _groups(self, bound: Sequence[Bound]) -> tuple[list[Any], Any]:
        """Filled descriptor sets, from the first to the last that anything lies in, and the pipeline's layout."""
        count = 1 + max(one.group for one in bound)
        slots: list[list[Any]] = [[] for _ in range(count)]
        for one in bound:
            slot = vk.VkDescriptorSetLayoutBinding(one.binding, KINDS[one.uniform], 1, STAGES)
            slots[one.group].append(slot)
        layouts = [self._make("DescriptorSetLayout", pBindings=group) for group in slots]
        room = [vk.VkDescriptorPoolSize(kind, len(bound)) for kind in KINDS.values()]
        pool = self._make("DescriptorPool", maxSets=count, pPoolSizes=room)
        asked = vk.VkDescriptorSetAllocateInfo(descriptorPool=pool, pSetLayouts=layouts)
        groups = list(vk.vkAllocateDescriptorSets(self._device, asked))
        writes = [self._written(groups[one.group], one) for one in bound]
        vk.vkUpdateDescriptorSets(self._device, len(writes), writes, 0, None)
        return groups, self._make("PipelineLayout", pSetLayouts=layouts)

    def _written(self, group: Any, one: Bound) -> Any:
        buffer, _ = self._buffer(len(one.content), USAGES[one.uniform], one.content)
        info = vk.VkDescriptorBufferInfo(buffer, 0, len(one.content))
        return vk.VkWriteDescriptorSet(
            dstSet=group,
            dstBinding=one.binding,
            descriptorCount=1,
            descriptorType=KINDS[one.uniform],
            pBufferInfo=[info],
        )

    def _pipeline(self, stages: tuple[Stage, Stage], layout: Any, render_pass: Any, screen: tuple[int, int]) -> Any:
        kinds = (vk.VK_SHADER_STAGE_VERTEX_BIT, vk.VK_SHADER_STAGE_FRAGMENT_BIT)
        modules = [self._make("ShaderModule", codeSize=len(one.code), pCode=one.code) for one in stages]
        programs = [
            vk.VkPipelineShaderStageCreateInfo(stage=kind, module=module, pName=one.entry)
            for kind, module, one in zip(kinds, modules, stages, strict=True)
        ]
        upright = vk.VkViewport(0, screen[1], screen[0], -screen[1], 0, 1)
        area = vk.VkRect2D(extent=vk.VkExtent2D(*screen))
        asked = vk.VkGraphicsPipelineCreateInfo(
            pStages=programs,
            pVertexInputState=vk.VkPipelineVertexInputStateCreateInfo(),
            pInputAssemblyState=vk.VkPipelineInputAssemblyStateCreateInfo(
                topology=vk.VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST
            ),
            pViewportState=vk.VkPipelineViewportStateCreateInfo(pViewports=[upright], pScissors=[area]),
            pRasterizationState=vk.VkPipelineRasterizationStateCreateInfo(cullMode=vk.VK_CULL_MODE_NONE, lineWidth=1),
            pMultisampleState=vk.VkPipelineMultisampleStateCreateInfo(rasterizationSamples=vk.VK_SAMPLE_COUNT_1_BIT),
            pColorBlendState=vk.VkPipelineColorBlendStateCreateInfo(pAttachments=[_over()]),
            layout=layout,
            renderPass=render_pass,
        )
        made = vk.vkCreateGraphicsPipelines(self._device, None, 1, [asked], None)[0]
        self._made.callback(vk.vkDestroyPipeline, self._device, made, None)
        return made

    def _run(self, record: Callable[[Any], None]) -> None:
        """Record commands, and wait until they have run."""
        pool = self._make("CommandPool", queueFamilyIndex=0)
        asked = vk.VkCommandBufferAllocateInfo(
            commandPool=pool, level=vk.VK_COMMAND_BUFFER_LEVEL_PRIMARY, commandBufferCount=1
        )
        commands = vk.vkAllocateCommandBuffers(self._device, asked)[0]
        vk.vkBeginCommandBuffer(commands, vk.VkCommandBufferBeginInfo())
        record(commands)
        vk.vkEndCommandBuffer(commands)
        vk.vkQueueSubmit(self._queue, 1, [vk.VkSubmitInfo(pCommandBuffers=[commands])], None)
        vk.vkQueueWaitIdle(self._queue)


def _over() -> Any:
    """Blend One OneMinusSrcAlpha."""
    one, rest = vk.VK_BLEND_FACTOR_ONE, vk.VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA
    return vk.VkPipelineColorBlendAttachmentState(
        blendEnable=True,
        srcColorBlendFactor=one,
        dstColorBlendFactor=rest,
        srcAlphaBlendFactor=one,
        dstAlphaBlendFactor=rest,
        colorWriteMask=0b1111,
    )
