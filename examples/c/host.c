#include "host.h"

#include <stdio.h>
#include <stdlib.h>

#include "triangle_frag.h"
#include "triangle_vert.h"

void fail(const char *call, const char *why)
{
    fprintf(stderr, "%s: %s\n", call, why);
    exit(EXIT_FAILURE);
}

void check_vulkan(VkResult result, const char *call)
{
    if (result != VK_SUCCESS) {
        char text[32];
        snprintf(text, sizeof text, "VkResult %d", (int)result);
        fail(call, text);
    }
}

static VKAPI_ATTR VkBool32 VKAPI_CALL count_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                                    VkDebugUtilsMessageTypeFlagsEXT types,
                                                    const VkDebugUtilsMessengerCallbackDataEXT *data,
                                                    void *count)
{
    (void)severity;
    (void)types;
    fprintf(stderr, "validation: %s\n", data->pMessage);
    ++*(uint32_t *)count;
    return VK_FALSE;
}

void host_open_instance(Host *host)
{
    const char *asked = getenv("REVMAP_VALIDATION");
    const bool validate = asked != NULL && asked[0] == '1';
    const char *layer = "VK_LAYER_KHRONOS_validation";
    const char *extensions[] = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME,
                                VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME};
    const VkValidationFeatureEnableEXT enabled[] = {
        VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    const VkValidationFeaturesEXT checks = {
        .sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
        .enabledValidationFeatureCount = 1,
        .pEnabledValidationFeatures = enabled,
    };
    const VkApplicationInfo application = {
        .sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
        .pApplicationName = "engine",
        .apiVersion = VK_API_VERSION_1_3,
    };
    const VkInstanceCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
        .pNext = validate ? &checks : NULL,
        .pApplicationInfo = &application,
        .enabledLayerCount = validate ? 1 : 0,
        .ppEnabledLayerNames = &layer,
        .enabledExtensionCount = validate ? 2 : 0,
        .ppEnabledExtensionNames = extensions,
    };
    VK(vkCreateInstance(&info, NULL, &host->instance));
    if (validate) {
        const VkDebugUtilsMessengerCreateInfoEXT wanted = {
            .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
            .messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                               VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
            .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT |
                           VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT |
                           VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT,
            .pfnUserCallback = count_message,
            .pUserData = &host->messages,
        };
        PFN_vkCreateDebugUtilsMessengerEXT create =
            (PFN_vkCreateDebugUtilsMessengerEXT)vkGetInstanceProcAddr(
                host->instance, "vkCreateDebugUtilsMessengerEXT");
        VK(create(host->instance, &wanted, NULL, &host->messenger));
    }
}

static VkDeviceMemory allocate(const Host *host, VkMemoryRequirements needs, VkMemoryPropertyFlags wanted)
{
    VkPhysicalDeviceMemoryProperties all;
    vkGetPhysicalDeviceMemoryProperties(host->physical, &all);
    for (uint32_t n = 0; n < all.memoryTypeCount; ++n) {
        const bool fits = (needs.memoryTypeBits & (1u << n)) != 0;
        if (fits && (all.memoryTypes[n].propertyFlags & wanted) == wanted) {
            const VkMemoryAllocateInfo info = {
                .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                .allocationSize = needs.size,
                .memoryTypeIndex = n,
            };
            VkDeviceMemory memory;
            VK(vkAllocateMemory(host->device, &info, NULL, &memory));
            return memory;
        }
    }
    fail("allocate", "no such memory");
    return VK_NULL_HANDLE;
}

static Image make_image(const Host *host, VkFormat format, VkImageUsageFlags usage, VkImageAspectFlags aspect)
{
    Image made;
    const VkImageCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
        .imageType = VK_IMAGE_TYPE_2D,
        .format = format,
        .extent = {WIDTH, HEIGHT, 1},
        .mipLevels = 1,
        .arrayLayers = 1,
        .samples = VK_SAMPLE_COUNT_1_BIT,
        .usage = usage,
    };
    VK(vkCreateImage(host->device, &info, NULL, &made.image));
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(host->device, made.image, &needs);
    made.memory = allocate(host, needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    VK(vkBindImageMemory(host->device, made.image, made.memory, 0));
    const VkImageViewCreateInfo view = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
        .image = made.image,
        .viewType = VK_IMAGE_VIEW_TYPE_2D,
        .format = format,
        .subresourceRange = {aspect, 0, 1, 0, 1},
    };
    VK(vkCreateImageView(host->device, &view, NULL, &made.view));
    return made;
}

static void destroy_image(const Host *host, Image image)
{
    vkDestroyImageView(host->device, image.view, NULL);
    vkDestroyImage(host->device, image.image, NULL);
    vkFreeMemory(host->device, image.memory, NULL);
}

static VkShaderModule make_module(const Host *host, const uint32_t *words, size_t bytes)
{
    const VkShaderModuleCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
        .codeSize = bytes,
        .pCode = words,
    };
    VkShaderModule module;
    VK(vkCreateShaderModule(host->device, &info, NULL, &module));
    return module;
}

static void make_triangle(Host *host)
{
    const VkPushConstantRange pushed = {VK_SHADER_STAGE_VERTEX_BIT, 0, 16 * sizeof(float)};
    const VkPipelineLayoutCreateInfo layout = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
        .pushConstantRangeCount = 1,
        .pPushConstantRanges = &pushed,
    };
    VK(vkCreatePipelineLayout(host->device, &layout, NULL, &host->layout));
    VkPipelineShaderStageCreateInfo stages[2] = {
        {
            .sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
            .stage = VK_SHADER_STAGE_VERTEX_BIT,
            .module = make_module(host, triangle_vert, sizeof triangle_vert),
            .pName = "main",
        },
        {
            .sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
            .stage = VK_SHADER_STAGE_FRAGMENT_BIT,
            .module = make_module(host, triangle_frag, sizeof triangle_frag),
            .pName = "main",
        },
    };
    const VkPipelineVertexInputStateCreateInfo vertices = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO,
    };
    const VkPipelineInputAssemblyStateCreateInfo assembly = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
        .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST,
    };
    const VkPipelineViewportStateCreateInfo viewport = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
        .viewportCount = 1,
        .scissorCount = 1,
    };
    const VkPipelineRasterizationStateCreateInfo raster = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO,
        .lineWidth = 1.0f,
    };
    const VkPipelineMultisampleStateCreateInfo samples = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
        .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT,
    };
    const VkPipelineDepthStencilStateCreateInfo depth = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
        .depthTestEnable = VK_TRUE,
        .depthWriteEnable = VK_TRUE,
        .depthCompareOp = VK_COMPARE_OP_GREATER,
    };
    const VkPipelineColorBlendAttachmentState written = {
        .colorWriteMask = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT |
                          VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT,
    };
    const VkPipelineColorBlendStateCreateInfo blend = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
        .attachmentCount = 1,
        .pAttachments = &written,
    };
    const VkDynamicState states[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    const VkPipelineDynamicStateCreateInfo dynamic = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO,
        .dynamicStateCount = 2,
        .pDynamicStates = states,
    };
    const VkFormat color = COLOR_FORMAT;
    const VkPipelineRenderingCreateInfo rendering = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO,
        .colorAttachmentCount = 1,
        .pColorAttachmentFormats = &color,
        .depthAttachmentFormat = DEPTH_FORMAT,
    };
    const VkGraphicsPipelineCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
        .pNext = &rendering,
        .stageCount = 2,
        .pStages = stages,
        .pVertexInputState = &vertices,
        .pInputAssemblyState = &assembly,
        .pViewportState = &viewport,
        .pRasterizationState = &raster,
        .pMultisampleState = &samples,
        .pDepthStencilState = &depth,
        .pColorBlendState = &blend,
        .pDynamicState = &dynamic,
        .layout = host->layout,
    };
    VK(vkCreateGraphicsPipelines(host->device, VK_NULL_HANDLE, 1, &info, NULL, &host->triangle));
    vkDestroyShaderModule(host->device, stages[0].module, NULL);
    vkDestroyShaderModule(host->device, stages[1].module, NULL);
}

void host_open_device(Host *host, const VkPhysicalDeviceFeatures *features)
{
    const float priority = 1.0f;
    const VkDeviceQueueCreateInfo queue = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
        .queueFamilyIndex = host->family,
        .queueCount = 1,
        .pQueuePriorities = &priority,
    };
    VkPhysicalDeviceVulkan13Features newer = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES,
        .dynamicRendering = VK_TRUE,
    };
    const VkDeviceCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
        .pNext = &newer,
        .queueCreateInfoCount = 1,
        .pQueueCreateInfos = &queue,
        .pEnabledFeatures = features,
    };
    VK(vkCreateDevice(host->physical, &info, NULL, &host->device));
    vkGetDeviceQueue(host->device, host->family, 0, &host->queue);
    const VkCommandPoolCreateInfo pool = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
        .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
        .queueFamilyIndex = host->family,
    };
    VK(vkCreateCommandPool(host->device, &pool, NULL, &host->pool));
    for (int n = 0; n < FRAMES_IN_FLIGHT; ++n) {
        Slot *slot = &host->slots[n];
        const VkCommandBufferAllocateInfo commands = {
            .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
            .commandPool = host->pool,
            .commandBufferCount = 1,
        };
        VK(vkAllocateCommandBuffers(host->device, &commands, &slot->commands));
        const VkFenceCreateInfo fence = {
            .sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO,
            .flags = VK_FENCE_CREATE_SIGNALED_BIT,
        };
        VK(vkCreateFence(host->device, &fence, NULL, &slot->done));
        slot->color = make_image(host, COLOR_FORMAT,
                                 VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                                 VK_IMAGE_ASPECT_COLOR_BIT);
        slot->depth = make_image(host, DEPTH_FORMAT, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT,
                                 VK_IMAGE_ASPECT_DEPTH_BIT);
        const VkBufferCreateInfo pixels = {
            .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
            .size = 4 * WIDTH * HEIGHT,
            .usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT,
        };
        VK(vkCreateBuffer(host->device, &pixels, NULL, &slot->pixels));
        VkMemoryRequirements needs;
        vkGetBufferMemoryRequirements(host->device, slot->pixels, &needs);
        slot->pixels_memory = allocate(host, needs,
                                       VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT |
                                           VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
        VK(vkBindBufferMemory(host->device, slot->pixels, slot->pixels_memory, 0));
    }
    make_triangle(host);
}

void host_close(Host *host)
{
    VK(vkDeviceWaitIdle(host->device));
    for (int n = 0; n < FRAMES_IN_FLIGHT; ++n) {
        Slot *slot = &host->slots[n];
        vkDestroyFence(host->device, slot->done, NULL);
        destroy_image(host, slot->color);
        destroy_image(host, slot->depth);
        vkDestroyBuffer(host->device, slot->pixels, NULL);
        vkFreeMemory(host->device, slot->pixels_memory, NULL);
    }
    vkDestroyPipeline(host->device, host->triangle, NULL);
    vkDestroyPipelineLayout(host->device, host->layout, NULL);
    vkDestroyCommandPool(host->device, host->pool, NULL);
    vkDestroyDevice(host->device, NULL);
    if (host->messenger != VK_NULL_HANDLE) {
        PFN_vkDestroyDebugUtilsMessengerEXT destroy =
            (PFN_vkDestroyDebugUtilsMessengerEXT)vkGetInstanceProcAddr(
                host->instance, "vkDestroyDebugUtilsMessengerEXT");
        destroy(host->instance, host->messenger, NULL);
    }
    vkDestroyInstance(host->instance, NULL);
}

static void change_layout(VkCommandBuffer commands, VkImage image, VkImageAspectFlags aspect,
                          VkImageLayout from, VkImageLayout to, VkPipelineStageFlags before,
                          VkAccessFlags written, VkPipelineStageFlags after, VkAccessFlags read)
{
    const VkImageMemoryBarrier barrier = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
        .srcAccessMask = written,
        .dstAccessMask = read,
        .oldLayout = from,
        .newLayout = to,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = image,
        .subresourceRange = {aspect, 0, 1, 0, 1},
    };
    vkCmdPipelineBarrier(commands, before, after, 0, 0, NULL, 0, NULL, 1, &barrier);
}

VkCommandBuffer host_begin(Host *host, uint32_t slot)
{
    VkCommandBuffer commands = host->slots[slot].commands;
    VK(vkWaitForFences(host->device, 1, &host->slots[slot].done, VK_TRUE, UINT64_MAX));
    const VkCommandBufferBeginInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    VK(vkBeginCommandBuffer(commands, &info));
    return commands;
}

void host_begin_pass(const Host *host, uint32_t number)
{
    const Slot *slot = &host->slots[number];
    const VkPipelineStageFlags tests =
        VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;
    change_layout(slot->commands, slot->color.image, VK_IMAGE_ASPECT_COLOR_BIT,
                  VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                  VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT, 0,
                  VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
                  VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT);
    change_layout(slot->commands, slot->depth.image, VK_IMAGE_ASPECT_DEPTH_BIT,
                  VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, tests, 0, tests,
                  VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT |
                      VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT);
    const VkRenderingAttachmentInfo color = {
        .sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
        .imageView = slot->color.view,
        .imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
        .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
        .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
        .clearValue.color.float32 = {0.2f, 0.25f, 0.3f, 1.0f},
    };
    const VkRenderingAttachmentInfo depth = {
        .sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
        .imageView = slot->depth.view,
        .imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
        .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
        .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
        .clearValue.depthStencil = {0.0f, 0},
    };
    const VkRect2D area = {{0, 0}, {WIDTH, HEIGHT}};
    const VkRenderingInfo info = {
        .sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
        .renderArea = area,
        .layerCount = 1,
        .colorAttachmentCount = 1,
        .pColorAttachments = &color,
        .pDepthAttachment = &depth,
    };
    vkCmdBeginRendering(slot->commands, &info);
    const VkViewport viewport = {0.0f, 0.0f, WIDTH, HEIGHT, 0.0f, 1.0f};
    vkCmdSetViewport(slot->commands, 0, 1, &viewport);
    vkCmdSetScissor(slot->commands, 0, 1, &area);
}

void host_draw_triangle(const Host *host, uint32_t slot, const float clip_from_world[16])
{
    VkCommandBuffer commands = host->slots[slot].commands;
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, host->triangle);
    vkCmdPushConstants(commands, host->layout, VK_SHADER_STAGE_VERTEX_BIT, 0, 16 * sizeof(float),
                       clip_from_world);
    vkCmdDraw(commands, 3, 1, 0, 0);
}

void host_submit(const Host *host, uint32_t number)
{
    const Slot *slot = &host->slots[number];
    vkCmdEndRendering(slot->commands);
    change_layout(slot->commands, slot->color.image, VK_IMAGE_ASPECT_COLOR_BIT,
                  VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                  VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT, VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
                  VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT);
    const VkBufferImageCopy whole = {
        .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
        .imageExtent = {WIDTH, HEIGHT, 1},
    };
    vkCmdCopyImageToBuffer(slot->commands, slot->color.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                           slot->pixels, 1, &whole);
    const VkMemoryBarrier read = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
        .srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT,
        .dstAccessMask = VK_ACCESS_HOST_READ_BIT,
    };
    vkCmdPipelineBarrier(slot->commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1,
                         &read, 0, NULL, 0, NULL);
    VK(vkEndCommandBuffer(slot->commands));
    VK(vkResetFences(host->device, 1, &slot->done));
    const VkSubmitInfo info = {
        .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
        .commandBufferCount = 1,
        .pCommandBuffers = &slot->commands,
    };
    VK(vkQueueSubmit(host->queue, 1, &info, slot->done));
}

void host_write(const Host *host, uint32_t number, const char *path)
{
    const Slot *slot = &host->slots[number];
    VK(vkWaitForFences(host->device, 1, &slot->done, VK_TRUE, UINT64_MAX));
    void *mapped;
    VK(vkMapMemory(host->device, slot->pixels_memory, 0, VK_WHOLE_SIZE, 0, &mapped));
    const unsigned char *pixels = mapped;
    FILE *file = fopen(path, "wb");
    if (file == NULL) {
        fail(path, "cannot be written");
    }
    fprintf(file, "P6\n%d %d\n255\n", WIDTH, HEIGHT);
    for (int n = 0; n < WIDTH * HEIGHT; ++n) {
        fwrite(pixels + 4 * n, 1, 3, file);
    }
    if (fclose(file) != 0) {
        fail(path, "cannot be written");
    }
    vkUnmapMemory(host->device, slot->pixels_memory);
}
