#include "program.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

namespace lendulet::test {

namespace {

struct ScratchDirectory {
    std::filesystem::path path = std::filesystem::temp_directory_path() / ("lendulet_test_" + std::to_string(getpid()));
    ScratchDirectory() { std::filesystem::create_directories(path); }
    ~ScratchDirectory() {
        std::error_code ignored;
        std::filesystem::remove_all(path, ignored);
    }
};

}  // namespace

std::string scratch(const std::string& name) {
    static ScratchDirectory directory;
    return (directory.path / name).string();
}

Outcome lendulet(const std::vector<std::string>& arguments, int interrupt_after_ms, size_t most_bytes) {
    std::string out_path = scratch("stdout"), err_path = scratch("stderr");
    std::vector<char*> argv{const_cast<char*>(LENDULET_CLI_PATH)};
    for (const std::string& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
    argv.push_back(nullptr);
    pid_t child = fork();
    if (child == 0) {
        int in = open("/dev/null", O_RDONLY);
        int out = open(out_path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        int err = open(err_path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        dup2(in, 0), dup2(out, 1), dup2(err, 2);
        const rlimit limit{most_bytes, most_bytes};
        if (most_bytes > 0) setrlimit(RLIMIT_AS, &limit);
        execv(argv[0], argv.data());
        _exit(127);
    }
    if (interrupt_after_ms >= 0) {
        std::this_thread::sleep_for(std::chrono::milliseconds(interrupt_after_ms));
        kill(child, SIGINT);
    }
    int status = 0;
    rusage usage{};
    wait4(child, &status, 0, &usage);
    Outcome outcome;
    outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    outcome.out = content(out_path);
    outcome.err = content(err_path);
    outcome.peak_kilobytes = usage.ru_maxrss;
    return outcome;
}

std::string content(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

void expect_refused(const std::vector<std::string>& arguments, const std::string& part) {
    Outcome outcome = lendulet(arguments);
    std::string line;
    for (const std::string& a : arguments) line += a + ' ';
    EXPECT_EQ(outcome.exit_code, 2) << line << outcome.err;
    EXPECT_EQ(outcome.out, "") << line;
    EXPECT_EQ(outcome.err.rfind("lendulet: ", 0), 0u) << line << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << line << outcome.err;
    EXPECT_NE(outcome.err.find(part), std::string::npos) << line << outcome.err;
}

}  // namespace lendulet::test
