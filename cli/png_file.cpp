#include "png_file.h"

#ifdef BELTRAMI_PNG
#include <png.h>
#endif

#include <fmt/format.h>

#include <beltrami/base/error.h>
#include <beltrami/io/atomic_file.h>
#include <beltrami/io/read_file.h>

namespace beltrami::cli {

#ifdef BELTRAMI_PNG

namespace {

constexpr png_uint_32 kMostPixels = 400'000'000;

/// libpng's, freed in the end.
struct Image {
    png_image value{};
    Image() { value.version = PNG_IMAGE_VERSION; }
    Image(const Image&) = delete;
    ~Image() { png_image_free(&value); }
};

}  // namespace

Picture read_png(const std::string& path) {
    const std::string bytes = read_file(path);
    Image image;
    const auto fail = [&](const std::string& why) {
        throw Error(Cause::unreadable, fmt::format("{} is no PNG that can be read: {}", path, why),
                    "convert the picture to PNG");
    };
    if (!png_image_begin_read_from_memory(&image.value, bytes.data(), bytes.size())) fail(image.value.message);
    if (image.value.width > kMostPixels / image.value.height) fail("it has too many pixels");
    image.value.format = PNG_FORMAT_RGBA;
    Picture picture{static_cast<int>(image.value.width), static_cast<int>(image.value.height), {}};
    picture.rgba.resize(PNG_IMAGE_SIZE(image.value));
    if (!png_image_finish_read(&image.value, nullptr, picture.rgba.data(), 0, nullptr)) fail(image.value.message);
    return picture;
}

void write_png(const std::string& path, const Picture& picture) {
    Image image;
    image.value.width = static_cast<png_uint_32>(picture.width);
    image.value.height = static_cast<png_uint_32>(picture.height);
    image.value.format = PNG_FORMAT_RGBA;
    png_alloc_size_t size = 0;
    std::string bytes;
    const auto write = [&](void* to) {
        return png_image_write_to_memory(&image.value, to, &size, 0, picture.rgba.data(), 0, nullptr) != 0;
    };
    bool written = write(nullptr);
    if (written) {
        bytes.resize(size);
        written = write(bytes.data());
    }
    if (!written) throw Error(Cause::unwritable, fmt::format("{} cannot be made: {}", path, image.value.message));
    bytes.resize(size);
    write_atomically(path, bytes);
}

#else

namespace {

[[noreturn]] void refuse() {
    throw Error(Cause::unreadable, "this command was built without libpng, and knows no pictures",
                "install libpng-dev and build it again");
}

}  // namespace

Picture read_png(const std::string&) {
    refuse();
}

void write_png(const std::string&, const Picture&) {
    refuse();
}

#endif

}  // namespace beltrami::cli
