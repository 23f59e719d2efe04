// Errors as values: whatever can be refused returns a value or an error with a sentence, and on an error nothing has
// changed. The core neither throws nor prints; `value()` on an error prints the sentence and ends the program.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

namespace lendulet {

// What kind of input was refused.
enum class ErrorCode : uint8_t {
    non_finite,       // NaN or infinity where a number is needed
    bad_rotation,     // a quaternion whose length is not 1 within 1e-3
    bad_mass,         // mass not positive or out of range
    bad_inertia,      // inertia not positive or violating the triangle inequality
    bad_extent,       // a shape's size not positive or out of range
    degenerate_hull,  // points that span no volume
    too_many_vertices,
    bad_mesh,           // empty, index out of range, non-finite vertex
    bad_collider,       // body without colliders, or a collider that cannot be used there
    shape_not_dynamic,  // a plane on a moving body
    bad_material,       // friction or restitution out of range
    bad_time_step,      // negative or non-finite step
    bad_joint,          // limits reversed, zero axis, same body twice
    no_dynamic_body,    // a joint between two bodies that cannot move
    stale_id,           // the body, collider or joint was removed
    wrong_world,        // a handle that another world gave out
    bad_config,         // a world setting out of range
    bad_query,          // zero or non-finite direction
    locked,             // called from inside a step
    out_of_world,       // farther from the origin than positions resolve
    unknown_name,       // no scene, option or structure of that name
    parse,              // a file that is malformed
    io,                 // a file that cannot be read or written
    bad_snapshot,       // bytes that no snapshot() gave, or not all of them
};

// A refused call: the kind and one sentence with what and where.
struct Error {
    ErrorCode code;
    std::string message;
};

namespace detail {
// Prints the sentence on standard error and ends the program with exit code 2.
[[noreturn]] void fail(const Error& error);
}  // namespace detail

// A value of type T, or an Error.
template <class T>
class [[nodiscard]] Result {
public:
    Result(T value) : ok_(true) { ::new (static_cast<void*>(&value_)) T(std::move(value)); }
    Result(Error error) : ok_(false) { ::new (static_cast<void*>(&error_)) Error(std::move(error)); }
    Result(Result&& other) noexcept : ok_(other.ok_) {
        if (ok_) ::new (static_cast<void*>(&value_)) T(std::move(other.value_));
        else ::new (static_cast<void*>(&error_)) Error(std::move(other.error_));
    }
    Result& operator=(Result&& other) noexcept {
        if (this != &other) {
            this->~Result();
            ::new (static_cast<void*>(this)) Result(std::move(other));
        }
        return *this;
    }
    ~Result() {
        if (ok_) value_.~T();
        else error_.~Error();
    }

    bool ok() const { return ok_; }
    explicit operator bool() const { return ok_; }

    // The value; on an error prints its sentence and ends the program.
    T& value() & { return check(), value_; }
    const T& value() const& { return check(), value_; }
    T&& value() && { return check(), std::move(value_); }
    T value_or(T fallback) && { return ok_ ? std::move(value_) : std::move(fallback); }

    // The error; only where !ok().
    const Error& error() const { return error_; }

private:
    void check() const {
        if (!ok_) detail::fail(error_);
    }
    bool ok_;
    union {
        T value_;
        Error error_;
    };
};

// Nothing, or an Error.
template <>
class [[nodiscard]] Result<void> {
public:
    Result() = default;
    Result(Error error) : error_(std::move(error)), ok_(false) {}
    bool ok() const { return ok_; }
    explicit operator bool() const { return ok_; }
    void value() const {
        if (!ok_) detail::fail(error_);
    }
    const Error& error() const { return error_; }

private:
    Error error_{ErrorCode::non_finite, {}};
    bool ok_ = true;
};
using Status = Result<void>;

}  // namespace lendulet
