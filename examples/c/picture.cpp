// A picture in C++17 without a host: a drawing turned about its axis.
//
//     picture DRAWING.svg OUT.png
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <revmap.hpp>

static void draw(const char *drawing, const char *png)
{
    const auto device = revmap::make<revmap::Device>(revmap_device_open, nullptr, 0u);
    const auto profile = revmap::make<revmap::Profile>(revmap_profile_from_file, drawing, REVMAP_AXIS_CENTER);

    auto object = revmap::defaulted(revmap_object_defaults);
    object.profile = profile.get();
    object.color[2] = 0.4f;
    object.offset.extend = -0.02; // slimmer all round

    auto scene = revmap::defaulted(revmap_scene_defaults);
    scene.camera.eye[2] = 1.25;
    scene.objects = &object;
    scene.object_count = 1;

    auto picture = revmap::defaulted(revmap_picture_defaults);
    picture.width = 480;
    picture.height = 360;
    const auto offscreen = revmap::make<revmap::Offscreen>(revmap_offscreen_create, device.get(), &picture, &scene);
    auto times = revmap::sized<RevmapTimes>();
    revmap::check(revmap_offscreen_draw(offscreen.get(), &times));
    revmap::check(revmap_offscreen_write_png(offscreen.get(), png));
    revmap::check(revmap_device_check(device.get()));
    std::printf("%s: %.1f ms\n", png, times.frame_ms);
}

int main(int count, char **arguments)
{
    if (count != 3) {
        std::fprintf(stderr, "picture DRAWING.svg OUT.png\n");
        return 2;
    }
    try {
        draw(arguments[1], arguments[2]);
        return EXIT_SUCCESS;
    } catch (const std::exception &error) {
        std::fprintf(stderr, "%s\n", error.what());
        return EXIT_FAILURE;
    }
}
