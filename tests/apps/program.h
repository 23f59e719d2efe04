// Runs the real program, as a user would, and catches what it says.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace lendulet::test {

struct Outcome {
    int exit_code = -1;  // 128 + signal where it died of one
    std::string out, err;
    long peak_kilobytes = 0;
};

// Runs `lendulet` with these arguments in the repository's root. Where `interrupt_after_ms` is not negative, sends it
// an interrupt (as Ctrl-C does) that much later. `most_bytes`: of memory that it gets, 0: as much as there is.
Outcome lendulet(const std::vector<std::string>& arguments, int interrupt_after_ms = -1, size_t most_bytes = 0);

// A path in a directory of this process' own, which is removed at its end.
std::string scratch(const std::string& name);
// What a file holds; nothing where there is none.
std::string content(const std::string& path);

// Expects exit code 2, nothing on standard output and one sentence with `part` in it on standard error.
void expect_refused(const std::vector<std::string>& arguments, const std::string& part);

}  // namespace lendulet::test
