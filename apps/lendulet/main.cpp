// The command line program `lendulet`.
#include <cstdio>
#include <exception>
#include <new>

#include "apps/lendulet/commands.h"

int lendulet::cli::fail(std::string_view sentence) {
    std::string line(sentence);
    while (!line.empty() && (line.back() == '\n' || line.back() == ' ')) line.pop_back();
    for (char& c : line) {
        if (c == '\n' || c == '\r') c = ' ';
    }
    std::fprintf(stderr, "lendulet: %s\n", line.c_str());
    return 2;
}

int main(int argc, char** argv) {
    try {
        return lendulet::cli::execute(argc, argv);
    } catch (const std::bad_alloc&) {  // of what the core asks for itself it says so too
        return lendulet::cli::fail("out of memory");
    } catch (const std::exception& problem) {  // such as no more threads
        return lendulet::cli::fail(problem.what());
    }
}
