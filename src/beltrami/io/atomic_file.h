#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <beltrami/base/public.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A file that appears under its name only once it is complete: until commit() the bytes go to a temporary file
/// in the same folder (.beltrami-….tmp), which is removed if commit() is never reached. An existing file of that name
/// keeps its permissions, and its contents until then. A symbolic link is followed. A pipe or a device such as
/// /dev/null, which cannot be replaced, is written directly.
class AtomicFile {
  public:
    enum class Durability {
        quick,   ///< the file survives the end of the program
        synced,  ///< commit() returns when the data are on the disk: the file survives a power cut
    };

    /// Creates the temporary file.
    /// @throw Error unwritable with the system's reason
    explicit AtomicFile(const std::filesystem::path& target);
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;
    ~AtomicFile();

    /// Appends bytes. @throw Error unwritable, for instance if the disk is full; the temporary file is removed
    void write(std::string_view bytes);
    /// Gives the file its name. Nothing may be written afterwards. @throw Error unwritable as write()
    void commit(Durability durability = Durability::quick);

  private:
    [[noreturn]] void fail(int error_number);
    void discard() noexcept;

    std::filesystem::path target_;
    std::filesystem::path temporary_;  ///< empty if the target is written directly
    int descriptor_ = -1;
    int registration_ = -1;  ///< place in the registry of temporary files
};

/// Writes a whole file at once, as AtomicFile does.
/// @throw Error unwritable
void write_atomically(const std::filesystem::path& path, std::string_view bytes,
                      AtomicFile::Durability durability = AtomicFile::Durability::quick);

/// Removes the temporary files of all AtomicFile objects that are alive. Only async-signal-safe calls are made:
/// meant for a handler of SIGINT or SIGTERM that ends the program right afterwards. At most 64 files at a time
/// are known to it.
void remove_temporaries_from_signal_handler() noexcept;

}  // namespace beltrami
