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

// The tables of one set of kernels, by lanes; null where they are not compiled. Builds with LENDULET_FOUR_LANES have
// none of more than four: WebAssembly, where they would only make the module larger, and sanitizers, where compiling
// them takes minutes. Those of eight and sixteen in the instructions that every machine has are slower than four and
// take minutes too: they are there in builds with LENDULET_EMULATED_LANES, to compare widths on machines without the
// wider instructions. All give the same bits.
template <class Table>
struct KernelTables {
    const Table *one, *four, *eight, *sixteen;
    const Table *avx2, *avx512;  // of eight and sixteen lanes, for machines that have these instructions
    const Table* avx512_of_eight = nullptr;

    // The widest of at most `width` lanes, in the instructions of this machine.
    const Table& of(int width) const {
        if (width >= 16 && avx512 && cpu_has_avx512()) return *avx512;
        if (width >= 16 && sixteen) return *sixteen;
        if (width >= 8 && avx512_of_eight && cpu_has_avx512()) return *avx512_of_eight;
        if (width >= 8 && avx2 && cpu_has_avx2()) return *avx2;
        if (width >= 8 && eight) return *eight;
        return width >= 4 || !one ? *four : *one;
    }
};

}  // namespace lendulet
