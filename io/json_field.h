// Reading JSON that nobody has checked: bounded parsing, and fields that know where they stand, so that every refusal
// says what is wrong and where. Refusals are thrown as LoadFailure inside the loader and become a Result at its door.
#pragma once

#include <cstdint>
#include <exception>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lendulet/math.h"
#include "lendulet/result.h"

namespace lendulet {

using Json = nlohmann::json;

// Thrown by the loader's parts, caught by load_gltf.
class LoadFailure : public std::exception {
public:
    explicit LoadFailure(Error error) : error_(std::move(error)) {}
    const Error& error() const { return error_; }
    const char* what() const noexcept override { return error_.message.c_str(); }

private:
    Error error_;
};
[[noreturn]] void refuse(const std::string& where, const std::string& what, ErrorCode code = ErrorCode::parse);

// A value of a JSON document, or its absence, with its path from the document's root ("nodes[3].mesh").
class Field {
public:
    Field(const Json* value, std::string where) : value_(value), where_(std::move(where)) {}

    bool present() const { return value_ != nullptr; }
    explicit operator bool() const { return present(); }
    const std::string& where() const { return where_; }
    const Json& json() const { return *value_; }

    // The member of that name; absent where this is absent. Refuses where this is no object.
    Field operator[](const char* key) const;
    // Elements of an array, 0 where absent. Refuses where this is no array.
    size_t size() const;
    Field at(size_t index) const;

    // Values; each refuses another type, and numbers that no float can hold.
    double number() const;
    double number_or(double fallback) const { return present() ? number() : fallback; }
    bool boolean_or(bool fallback) const;
    const std::string& text() const;
    uint64_t count() const;  // a whole number from 0 to 2^53
    uint64_t count_or(uint64_t fallback) const { return present() ? count() : fallback; }
    // An index below `limit` of the array called `array`.
    int index(size_t limit, const char* array) const;
    int index_or(int fallback, size_t limit, const char* array) const {
        return present() ? index(limit, array) : fallback;
    }
    // Exactly `n` numbers.
    std::vector<double> numbers(size_t n) const;
    Vec3 vector_or(Vec3 fallback) const;

    [[noreturn]] void refuse(const std::string& what) const { lendulet::refuse(where_, what); }

private:
    const Json* value_;
    std::string where_;
};

// A document without the top-level members that nobody asked for.
struct ParsedJson {
    Json root;
    std::vector<std::string> dropped;  // names of those members
};

// Parses JSON text, keeping the top-level members listed in `keep`. Refuses malformed text with line and column, values
// nested deeper than 64, and text whose values would take more than `memory_limit` bytes; the size of a value tree can
// exceed that of its text thirty times, so it is counted before it is built.
ParsedJson parse_json(std::string_view text, const std::vector<std::string_view>& keep, uint64_t memory_limit);

}  // namespace lendulet
