/* A small engine of its own: device, images, two frames in flight, one triangle. Nothing here is revmap's. */
#ifndef HOST_H
#define HOST_H

#include <stdbool.h>
#include <stdint.h>
#include <vulkan/vulkan.h>

enum { WIDTH = 640, HEIGHT = 480, FRAMES_IN_FLIGHT = 2 };

#define COLOR_FORMAT VK_FORMAT_R8G8B8A8_SRGB
#define DEPTH_FORMAT VK_FORMAT_D32_SFLOAT

/* Ends the program with a line that names the call. */
void fail(const char *call, const char *why);
void check_vulkan(VkResult result, const char *call);
#define VK(call) check_vulkan((call), #call)

typedef struct Image {
    VkImage image;
    VkImageView view;
    VkDeviceMemory memory;
} Image;

/* What one frame in flight needs. */
typedef struct Slot {
    VkCommandBuffer commands;
    VkFence done;
    Image color, depth;
    VkBuffer pixels; /* the picture, copied for the CPU */
    VkDeviceMemory pixels_memory;
} Slot;

typedef struct Host {
    VkInstance instance;
    VkDebugUtilsMessengerEXT messenger;
    uint32_t messages; /* of the validation layers */
    VkPhysicalDevice physical;
    VkDevice device;
    uint32_t family;
    VkQueue queue;
    VkCommandPool pool;
    VkPipelineLayout layout;
    VkPipeline triangle;
    Slot slots[FRAMES_IN_FLIGHT];
} Host;

/* An instance, with the validation layers where the environment has REVMAP_VALIDATION. */
void host_open_instance(Host *host);
/* The device itself, and all that is made on it. */
void host_open_device(Host *host, const VkPhysicalDeviceFeatures *features);
void host_close(Host *host);

/* Waits until the slot is free and begins its commands. */
VkCommandBuffer host_begin(Host *host, uint32_t slot);
/* Begins the pass: color and depth cleared, viewport and scissor set. Reversed depth: 0 is far. */
void host_begin_pass(const Host *host, uint32_t slot);
/* column-major, from world to clip space */
void host_draw_triangle(const Host *host, uint32_t slot, const float clip_from_world[16]);
/* Ends the pass, copies the picture, submits. */
void host_submit(const Host *host, uint32_t slot);
/* Waits for the slot and writes its picture as PPM. */
void host_write(const Host *host, uint32_t slot, const char *path);

#endif
