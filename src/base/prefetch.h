// Asking for memory before it is needed: lists name things that lie scattered, and a loop that waits for each of them
// in turn would spend most of its time so.
#pragma once

namespace lendulet {

// How many entries of a list ahead a loop asks.
inline constexpr int prefetch_distance = 8;

// The first bytes of an object, by cache lines; any address will do.
template <int Lines = 1>
inline void prefetch(const void* address) {
    for (int i = 0; i < Lines; ++i) __builtin_prefetch(static_cast<const char*>(address) + 64 * i);
}

}  // namespace lendulet
