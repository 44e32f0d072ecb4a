#include <beltrami/io/read_file.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <new>
#include <system_error>

#include <fmt/format.h>

#include <beltrami/base/error.h>

namespace beltrami {

namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& reason) {
    throw Error(Cause::unreadable, fmt::format("cannot read {}: {}", path.string(), reason),
                "check the file's name and its permissions");
}

}  // namespace

std::string read_file(const std::filesystem::path& path) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(path, error);
    if (status.type() == std::filesystem::file_type::not_found) fail(path, "there is no such file");
    if (error) fail(path, error.message());
    if (std::filesystem::is_directory(status)) fail(path, "it is a folder");
    // Devices are refused: some never end.
    if (!std::filesystem::is_regular_file(status) && !std::filesystem::is_fifo(status)) {
        fail(path, "it is neither a regular file nor a pipe");
    }

    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
    if (!file) fail(path, std::system_category().message(errno));
    std::string bytes;
    try {
        const std::uintmax_t size = std::filesystem::file_size(path, error);  // a pipe has none
        if (!error) bytes.reserve(size);
        std::array<char, 1 << 16> block;
        while (const std::size_t got = std::fread(block.data(), 1, block.size(), file.get())) {
            bytes.append(block.data(), got);
        }
    } catch (const std::exception&) {  // bad_alloc, or length_error of a size no string can have
        fail(path, "it does not fit into memory");
    }
    if (std::ferror(file.get())) fail(path, std::system_category().message(errno));
    return bytes;
}

}  // namespace beltrami
