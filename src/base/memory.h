// Memory of a world: every container below takes it from one Memory, which forwards to the user's allocator hook.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <new>
#include <type_traits>
#include <utility>

#include "base/assert.h"

namespace lendulet {

// Where memory comes from; all null: the heap. Mirrors the public AllocatorHook.
struct Memory {
    void* user = nullptr;
    void* (*allocate_hook)(void* user, size_t bytes, size_t alignment) = nullptr;
    void (*free_hook)(void* user, void* memory, size_t bytes, size_t alignment) = nullptr;

    void* allocate(size_t bytes) const;
    // Memory of `bytes` with the first `used` bytes of what was `old_bytes` long, which may be null. On the heap large
    // memory is not copied where the system can move its pages instead, and new pages cost what they cost when they are
    // written to: an array that grows in the middle of a step does not make that step a slow one.
    void* enlarge(void* old, size_t old_bytes, size_t used, size_t bytes) const;
    void free(void* memory, size_t bytes) const;
    // For arrays, whose memory may be null, the heap; out of line, since every loop that appends has them.
    // More room for `size` elements of so many bytes, at least for `wanted` of them, and the capacity that it then has.
    static void* grow(const Memory* memory, void* old, size_t element, size_t size, size_t& capacity, size_t wanted);
    static void release(const Memory* memory, void* old, size_t bytes);
    static constexpr size_t alignment = 64;  // a cache line, and the widest vector
};

// A growable array of plain data, aligned to a cache line. Never shrinks its memory, so a step that needs no more room
// than an earlier one allocates nothing. Elements are trivially copyable; new ones are left unset by resize_unset().
template <class T>
class Array {
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

public:
    Array() = default;
    explicit Array(const Memory* memory) : memory_(memory) {}
    Array(const Array&) = delete;
    Array& operator=(const Array&) = delete;
    Array(Array&& o) noexcept { swap(o); }
    Array& operator=(Array&& o) noexcept {
        swap(o);
        return *this;
    }
    ~Array() { release(); }

    void set_memory(const Memory* memory) {
        LENDULET_ASSERT(data_ == nullptr);
        memory_ = memory;
    }
    size_t size() const { return size_; }
    int count() const { return static_cast<int>(size_); }
    size_t capacity() const { return capacity_; }
    bool empty() const { return size_ == 0; }
    T* data() { return data_; }
    const T* data() const { return data_; }
    T& operator[](size_t i) {
        LENDULET_ASSERT(i < size_);
        return data_[i];
    }
    const T& operator[](size_t i) const {
        LENDULET_ASSERT(i < size_);
        return data_[i];
    }
    T* begin() { return data_; }
    T* end() { return data_ + size_; }
    const T* begin() const { return data_; }
    const T* end() const { return data_ + size_; }
    T& back() { return (*this)[size_ - 1]; }
    const T& back() const { return (*this)[size_ - 1]; }

    void clear() { size_ = 0; }
    void reserve(size_t n) {
        if (n > capacity_) [[unlikely]]
            grow(n);
    }
    // Reserves, and writes to what of it is not in use: the system hands out memory page by page where it is touched
    // first, which may take longer than all that is done with it.
    void make_ready(size_t n) {
        constexpr size_t page = 4096;
        reserve(n);
        volatile auto* bytes = reinterpret_cast<unsigned char*>(data_);
        for (size_t i = size_ * sizeof(T); i < n * sizeof(T); i += page) bytes[i] = 0;
    }
    void resize_unset(size_t n) {
        reserve(n);
        size_ = n;
    }
    void resize(size_t n, T fill = T{}) {
        reserve(n);
        for (size_t i = size_; i < n; ++i) data_[i] = fill;
        size_ = n;
    }
    void assign(size_t n, T fill) {
        size_ = 0;
        resize(n, fill);
    }
    T& push_back(const T& value) {
        T copy = value;  // may lie in this array
        if (size_ == capacity_) [[unlikely]]
            grow(size_ + 1);
        data_[size_] = copy;
        return data_[size_++];
    }
    void pop_back() {
        LENDULET_ASSERT(size_ > 0);
        --size_;
    }
    void append(const T* values, size_t n) {
        reserve(size_ + n);
        if (n) std::memcpy(static_cast<void*>(data_ + size_), values, n * sizeof(T));
        size_ += n;
    }
    void swap(Array& o) {
        std::swap(memory_, o.memory_);
        std::swap(data_, o.data_);
        std::swap(size_, o.size_);
        std::swap(capacity_, o.capacity_);
    }
    size_t bytes() const { return capacity_ * sizeof(T); }

private:
    void grow(size_t n) { data_ = static_cast<T*>(Memory::grow(memory_, data_, sizeof(T), size_, capacity_, n)); }
    void release() {
        if (data_) Memory::release(memory_, data_, capacity_ * sizeof(T));
        data_ = nullptr;
    }

    const Memory* memory_ = nullptr;
    T* data_ = nullptr;
    size_t size_ = 0, capacity_ = 0;
};

}  // namespace lendulet
