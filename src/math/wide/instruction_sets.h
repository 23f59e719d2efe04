// Which wide instruction sets this machine has. Tables of kernels are chosen by these.
#pragma once

namespace lendulet {

#if defined(__x86_64__)
inline bool has_avx2() { return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi2"); }
inline bool has_avx512() {
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl");
}
#endif

// The table for a width: the wide ones where the machine has their instructions, else the baseline's of that width.
template <class Table>
const Table& table_for_width(int width, const Table& one, const Table& four, const Table& eight, const Table& sixteen,
                             [[maybe_unused]] const Table* avx2, [[maybe_unused]] const Table* avx512) {
#if defined(__x86_64__)
    if (width == 16 && has_avx512()) return *avx512;
    if (width == 8 && has_avx2()) return *avx2;
#endif
    return width == 16 ? sixteen : width == 8 ? eight : width == 4 ? four : one;
}

}  // namespace lendulet
