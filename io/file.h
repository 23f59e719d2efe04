// Whole files in and out, with a limit on size and errors as sentences. Used by the loaders and the command line.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "lendulet/result.h"

namespace lendulet {

// The largest scene file (and the largest buffer beside it) that is read, in bytes.
inline constexpr uint64_t max_scene_file_bytes = uint64_t{256} << 20;

// The bytes of the regular file `path`. Error: io (not there, not a regular file, larger than `limit`, unreadable).
Result<std::string> read_file(const std::string& path, uint64_t limit = max_scene_file_bytes);

// Writes `content` to `path`, replacing what was there. Error: io.
Status write_file(const std::string& path, std::string_view content);

// Error io where the file cannot be written, so that a wrong name does not cost a long run; "" is no file. What is
// there stays, and nothing is left where nothing was.
Status check_writable(const std::string& path);
// Whether two names are those of one file, be it there or not. Devices may be named twice.
bool is_same_file(const std::string& a, const std::string& b);

// `text` with control characters and bytes outside ASCII replaced by '?' and cut to 200 characters, for messages that
// quote what a file or a command line says.
std::string printable(std::string_view text);

}  // namespace lendulet
