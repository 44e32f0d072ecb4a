#include <beltrami/io/atomic_file.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdint>
#include <cstring>
#include <random>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fmt/format.h>

#include <beltrami/base/error.h>

namespace beltrami {

namespace {

enum class State { free, being_filled, live };
static_assert(std::atomic<State>::is_always_lock_free, "a signal handler must not take locks");

/// One name a signal handler can read at any moment: it looks at the path only while the state is live.
struct Registration {
    std::atomic<State> state = State::free;
    std::array<char, PATH_MAX> path;
};
std::array<Registration, 64> registry;

/// @return the place, or -1 if the registry is full or the name too long for it
int register_temporary(const std::string& path) {
    if (path.size() >= PATH_MAX) return -1;
    for (std::size_t i = 0; i < registry.size(); ++i) {
        State expected = State::free;
        if (!registry[i].state.compare_exchange_strong(expected, State::being_filled)) continue;
        std::memcpy(registry[i].path.data(), path.c_str(), path.size() + 1);
        registry[i].state = State::live;
        return static_cast<int>(i);
    }
    return -1;
}

void unregister_temporary(int registration) {
    if (registration >= 0) registry[static_cast<std::size_t>(registration)].state = State::free;
}

std::filesystem::path temporary_beside(const std::filesystem::path& target) {
    std::random_device random;
    const std::uint64_t number = (std::uint64_t{random()} << 32) | random();
    return target.parent_path() / fmt::format(".beltrami-{:016x}.tmp", number);
}

}  // namespace

AtomicFile::AtomicFile(const std::filesystem::path& target) : target_(target) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(target, error);
    if (std::filesystem::is_directory(status)) fail(EISDIR);
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
        descriptor_ = ::open(target.c_str(), O_WRONLY | O_CLOEXEC);
        if (descriptor_ < 0) fail(errno);
        return;
    }
    // Replacing a file needs no leave to write to it, so that leave is asked for here.
    if (std::filesystem::exists(status) && ::access(target.c_str(), W_OK) != 0) fail(errno);

    // Absolute, for a signal may come after the program changed its folder; canonical, to follow a link.
    target_ = std::filesystem::absolute(target, error);
    if (!error) target_ = std::filesystem::weakly_canonical(target_, error);
    if (error) fail(error.value());
    temporary_ = temporary_beside(target_);
    registration_ = register_temporary(temporary_.string());
    descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ < 0) fail(errno);
    struct stat existing;
    if (::stat(target_.c_str(), &existing) == 0 && ::fchmod(descriptor_, existing.st_mode & 07777) != 0) fail(errno);
}

AtomicFile::~AtomicFile() {
    discard();
}

void AtomicFile::write(std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) fail(errno);
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
}

void AtomicFile::commit(Durability durability) {
    // A pipe has no disk to be synced to.
    if (durability == Durability::synced && !temporary_.empty() && ::fsync(descriptor_) != 0) fail(errno);
    // Some file systems report a full disk only here.
    if (::close(std::exchange(descriptor_, -1)) != 0) fail(errno);
    if (temporary_.empty()) return;
    if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail(errno);
    unregister_temporary(std::exchange(registration_, -1));
    temporary_.clear();
    if (durability == Durability::synced) {  // the new name itself
        const int folder = ::open(target_.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
        const bool synced = folder >= 0 && ::fsync(folder) == 0;
        const int error_number = errno;
        if (folder >= 0) ::close(folder);
        if (!synced) fail(error_number);
    }
}

void AtomicFile::fail(int error_number) {
    discard();
    const char* next_step = error_number == ENOENT                             ? "create the folder first"
                            : error_number == ENOSPC || error_number == EDQUOT ? "make room on the disk"
                            : error_number == EACCES || error_number == EPERM  ? "choose a place you may write to"
                                                                               : "choose another output";
    throw Error(Cause::unwritable,
                fmt::format("cannot write {}: {}", target_.string(), std::system_category().message(error_number)),
                next_step);
}

void AtomicFile::discard() noexcept {
    if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
    temporary_.clear();
    unregister_temporary(std::exchange(registration_, -1));
}

void write_atomically(const std::filesystem::path& path, std::string_view bytes, AtomicFile::Durability durability) {
    AtomicFile file(path);
    file.write(bytes);
    file.commit(durability);
}

void remove_temporaries_from_signal_handler() noexcept {
    for (const Registration& registration : registry) {
        if (registration.state == State::live) ::unlink(registration.path.data());
    }
}

}  // namespace beltrami
