// Which instruction sets this machine has, beyond what every one of its kind does, and with that which table of kernels
// serves a width. Kernels compiled for a wider set may be called only where its function says so.
#pragma once

namespace lendulet {

#if defined(__x86_64__)
inline bool cpu_has_avx2() { return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi2"); }
inline bool cpu_has_avx512() {
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
}
#else
inline bool cpu_has_avx2() { return false; }
inline bool cpu_has_avx512() { return false; }
#endif

// The widest vectors of this machine, in lanes.
inline int native_lanes() { return cpu_has_avx512() ? 16 : cpu_has_avx2() ? 8 : 4; }

// The table for a width: the wide ones where they are compiled and the machine has their instructions, else the
// baseline's of that width.
template <class Table>
const Table& table_for_width(int width, const Table& one, const Table& four, const Table& eight, const Table& sixteen,
                             const Table* avx2, const Table* avx512) {
    if (width == 16 && avx512 && cpu_has_avx512()) return *avx512;
    if (width == 8 && avx2 && cpu_has_avx2()) return *avx2;
    return width == 16 ? sixteen : width == 8 ? eight : width == 4 ? four : one;
}

}  // namespace lendulet
