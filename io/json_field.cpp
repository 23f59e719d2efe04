#include "io/json_field.h"

#include <algorithm>
#include <cmath>

#include "io/file.h"

namespace lendulet {

void refuse(const std::string& where, const std::string& what, ErrorCode code) {
    throw LoadFailure({code, where.empty() ? what : where + ": " + what});
}

// ---------------------------------------------------------------------------------------------------------------------
// Fields

Field Field::operator[](const char* key) const {
    std::string where = where_.empty() ? key : where_ + "." + key;
    if (!value_) return {nullptr, std::move(where)};
    if (!value_->is_object()) refuse("must be an object");
    auto found = value_->find(key);
    return {found == value_->end() ? nullptr : &*found, std::move(where)};
}

size_t Field::size() const {
    if (!value_) return 0;
    if (!value_->is_array()) refuse("must be an array");
    return value_->size();
}

Field Field::at(size_t index) const { return {&(*value_)[index], where_ + "[" + std::to_string(index) + "]"}; }

double Field::number() const {
    if (!value_) refuse("is missing");
    if (!value_->is_number()) refuse("must be a number");
    double v = value_->get<double>();
    if (!(std::abs(v) <= 3.4e38)) refuse("is out of range");
    return v;
}

bool Field::boolean_or(bool fallback) const {
    if (!value_) return fallback;
    if (!value_->is_boolean()) refuse("must be true or false");
    return value_->get<bool>();
}

const std::string& Field::text() const {
    if (!value_) refuse("is missing");
    if (!value_->is_string()) refuse("must be a string");
    return value_->get_ref<const std::string&>();
}

uint64_t Field::count() const {
    double v = number();
    if (v < 0.0 || v > 9007199254740992.0 || v != std::floor(v)) refuse("must be a whole number of at least 0");
    return static_cast<uint64_t>(v);
}

int Field::index(size_t limit, const char* array) const {
    uint64_t i = count();
    if (i >= limit) {
        refuse("names element " + std::to_string(i) + " of " + array + ", which has " + std::to_string(limit));
    }
    return static_cast<int>(i);
}

std::vector<double> Field::numbers(size_t n) const {
    if (size() != n) refuse("must have " + std::to_string(n) + " numbers");
    std::vector<double> out(n);
    for (size_t i = 0; i < n; ++i) out[i] = at(i).number();
    return out;
}

Vec3 Field::vector_or(Vec3 fallback) const {
    if (!value_) return fallback;
    std::vector<double> v = numbers(3);
    return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

// ---------------------------------------------------------------------------------------------------------------------
// Parsing

namespace {

constexpr int max_depth = 64;

bool is_kept(std::string_view name, const std::vector<std::string_view>& keep) {
    return std::find(keep.begin(), keep.end(), name) != keep.end();
}

// Builds the values of the kept members while it counts what they take, so that a hostile text is given up before its
// tree fills the memory.
class Builder : public nlohmann::json_sax<Json> {
public:
    Builder(const std::vector<std::string_view>& keep, uint64_t limit) : keep_(keep), limit_(limit) {}

    ParsedJson result;
    std::string problem;        // why building was ended
    size_t error_position = 0;  // of a syntax error, in bytes from 1; 0: elsewhere

    bool null() override { return add(nullptr, 0); }
    bool boolean(bool v) override { return add(v, 0); }
    bool number_integer(number_integer_t v) override { return add(v, 0); }
    bool number_unsigned(number_unsigned_t v) override { return add(v, 0); }
    bool number_float(number_float_t v, const string_t&) override { return add(v, 0); }
    bool string(string_t& v) override {
        if (!kept_) return true;
        uint64_t bytes = string_bytes + v.size();
        return add(std::move(v), bytes);
    }
    bool binary(binary_t&) override { return true; }
    bool start_object(size_t) override { return open(Json::value_t::object); }
    bool end_object() override { return close(); }
    bool start_array(size_t) override { return open(Json::value_t::array); }
    bool end_array() override { return close(); }
    bool key(string_t& name) override {
        if (depth_ == 1) {
            kept_ = is_kept(name, keep_);
            if (!kept_ && result.dropped.size() < 100) result.dropped.push_back(name);
        }
        if (!kept_) return true;
        uint64_t bytes = member_bytes + (name.size() > 15 ? name.size() + 16 : 0);
        member_ = &(*open_.back())[std::move(name)];
        return take(bytes);
    }
    bool parse_error(size_t position, const std::string&, const Json::exception&) override {
        error_position = position;
        problem = "is not valid JSON";
        return false;
    }

private:
    // Sizes on a 64-bit machine: a value is 16 bytes, twice that while an array grows; a member is a red-black tree
    // node with its key; a string, array or object is an allocation of its own.
    static constexpr uint64_t value_bytes = 32, member_bytes = 96, string_bytes = 48, container_bytes = 64;

    bool take(uint64_t bytes) {
        bytes_ += bytes;
        if (bytes_ <= limit_) return true;
        problem = "holds too many values for its size";
        return false;
    }
    template <class Value>
    Json* place(Value&& value) {
        if (open_.empty()) return &(result.root = std::forward<Value>(value));
        if (open_.back()->is_object()) return &(*member_ = std::forward<Value>(value));
        auto& array = open_.back()->get_ref<Json::array_t&>();
        array.emplace_back(std::forward<Value>(value));
        return &array.back();
    }
    template <class Value>
    bool add(Value&& value, uint64_t bytes) {
        if (!kept_) return true;
        place(std::forward<Value>(value));
        return take(value_bytes + bytes);
    }
    bool open(Json::value_t type) {
        if (++depth_ > max_depth) {
            problem = "is nested deeper than " + std::to_string(max_depth) + " levels";
            return false;
        }
        if (!kept_) return true;
        open_.push_back(place(Json(type)));
        return take(value_bytes + container_bytes);
    }
    bool close() {
        --depth_;
        if (depth_ <= 1 && !kept_) {
            kept_ = true;  // the end of a dropped member's value, or of the document after one
            if (depth_ == 1) return true;
        }
        if (kept_ && !open_.empty()) open_.pop_back();
        return true;
    }

    const std::vector<std::string_view>& keep_;
    uint64_t limit_, bytes_ = 0;
    int depth_ = 0;
    bool kept_ = true;
    std::vector<Json*> open_;  // objects and arrays that have not ended; arrays do not grow while an element is open
    Json* member_ = nullptr;   // where the value after a key goes
};

std::string line_and_column(std::string_view text, size_t position) {
    std::string_view before = text.substr(0, std::min(position, text.size()));
    size_t line = 1 + static_cast<size_t>(std::count(before.begin(), before.end(), '\n'));
    size_t line_start = before.rfind('\n');
    size_t column = line_start == std::string_view::npos ? before.size() : before.size() - line_start - 1;
    return " at line " + std::to_string(line) + ", column " + std::to_string(column);
}

}  // namespace

ParsedJson parse_json(std::string_view text, const std::vector<std::string_view>& keep, uint64_t memory_limit) {
    Builder builder(keep, memory_limit);
    if (!Json::sax_parse(text.begin(), text.end(), &builder)) {
        std::string where = builder.error_position ? line_and_column(text, builder.error_position) : "";
        refuse("", builder.problem + where);
    }
    if (!builder.result.root.is_object()) refuse("", "is not a JSON object");
    return std::move(builder.result);
}

}  // namespace lendulet
