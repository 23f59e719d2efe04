// What was asked for as JSON: members are read by name, and refusals are sentences.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "lendulet/lendulet_c.h"

namespace lendulet::cli {

using Json = nlohmann::json;

constexpr int most_bodies = 1 << 30;

// Reads members of a JSON object; what is of the wrong kind ends the request with a sentence.
struct Asked {
    struct Refused {
        std::string sentence;
    };
    const Json& json;

    bool has(const char* name) const { return json.contains(name); }
    double number(const char* name) const {
        auto it = json.find(name);
        if (it == json.end() || !it->is_number()) throw Refused{std::string(name) + " must be a number"};
        return it->get<double>();
    }
    int whole(const char* name, int most) const {
        double value = number(name);
        if (!(value >= 0.0 && value <= most) || value != static_cast<double>(static_cast<int>(value)))
            throw Refused{std::string(name) + " must be a whole number from 0 to " + std::to_string(most)};
        return static_cast<int>(value);
    }
    float real(const char* name) const { return static_cast<float>(number(name)); }
    std::string text(const char* name) const {
        auto it = json.find(name);
        if (it == json.end() || !it->is_string()) throw Refused{std::string(name) + " must be text"};
        return it->get<std::string>();
    }
    void vector(const char* name, float out[3]) const {
        auto it = json.find(name);
        bool good = it != json.end() && it->is_array() && it->size() == 3;
        for (size_t i = 0; good && i < 3; ++i) good = (*it)[i].is_number();
        if (!good) throw Refused{std::string(name) + " must be three numbers"};
        for (size_t i = 0; i < 3; ++i) out[i] = (*it)[i].get<float>();
    }
    const Json& object(const char* name) const {
        auto it = json.find(name);
        if (it == json.end() || !it->is_object()) throw Refused{std::string(name) + " must be an object"};
        return *it;
    }
    const Json& list(const char* name) const {
        auto it = json.find(name);
        if (it == json.end() || !it->is_array()) throw Refused{std::string(name) + " must be a list"};
        return *it;
    }
};

// What the C interface refuses ends the request too.
inline void must(lendulet_result result) {
    if (result < 0) throw Asked::Refused{lendulet_error()};
}

}  // namespace lendulet::cli
