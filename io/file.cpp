#include "io/file.h"

#include <filesystem>
#include <fstream>

namespace lendulet {
namespace {

Error cannot_be_written(const std::string& path) { return {ErrorCode::io, printable(path) + ": cannot be written"}; }

}  // namespace

Result<std::string> read_file(const std::string& path, uint64_t limit) {
    auto refuse = [&](const std::string& why) { return Error{ErrorCode::io, printable(path) + ": " + why}; };
    // A name with a zero byte inside would be cut by the operating system and mean another file.
    if (path.find('\0') != std::string::npos) return refuse("not a file name");
    std::error_code error;
    std::filesystem::file_status status = std::filesystem::status(path, error);
    if (error || !std::filesystem::exists(status)) return refuse("no such file");
    // Devices and pipes could block or never end.
    if (!std::filesystem::is_regular_file(status)) return refuse("not a regular file");
    uint64_t size = std::filesystem::file_size(path, error);
    if (error) return refuse("cannot be read");
    if (size > limit) return refuse("larger than " + std::to_string(limit >> 20) + " MB");
    std::ifstream in(path, std::ios::binary);
    if (!in) return refuse("cannot be opened for reading");
    std::string bytes(static_cast<size_t>(size), '\0');
    in.read(bytes.data(), static_cast<std::streamsize>(size));
    if (static_cast<uint64_t>(in.gcount()) != size) return refuse("cannot be read to its end");
    return bytes;
}

Status write_file(const std::string& path, std::string_view content) {
    std::ofstream out(path, std::ios::binary | std::ios::trunc);
    out.write(content.data(), static_cast<std::streamsize>(content.size()));
    out.close();
    return out ? Status{} : cannot_be_written(path);
}

Status check_writable(const std::string& path) {
    if (path.empty()) return {};
    std::error_code ignored;
    const bool is_there = std::filesystem::exists(std::filesystem::symlink_status(path, ignored));
    if (!std::ofstream(path, std::ios::binary | std::ios::app)) return cannot_be_written(path);
    if (!is_there) std::filesystem::remove(path, ignored);
    return {};
}

bool is_same_file(const std::string& a, const std::string& b) {
    namespace fs = std::filesystem;
    std::error_code ignored;
    if (fs::exists(a, ignored) && !fs::is_regular_file(a, ignored)) return false;
    return fs::weakly_canonical(a, ignored) == fs::weakly_canonical(b, ignored);
}

}  // namespace lendulet
