// What stands for peers that the build did not find.
#include "bench/collision/pairs.h"

namespace lendulet::bench {

std::vector<std::string> missing_collision_peers() {
    std::vector<std::string> missing;
#ifndef LENDULET_BENCH_BULLET
    missing.push_back("libbullet-dev");
#endif
#ifndef LENDULET_BENCH_CCD
    missing.push_back("libccd-dev");
#endif
#ifndef LENDULET_BENCH_FCL
    missing.push_back("libfcl-dev");
#endif
    return missing;
}

#ifndef LENDULET_BENCH_BULLET
void add_bullet_subjects(PairSubjects&) {}
std::vector<double> bullet_rays(const RayScene&, int, std::vector<double>&) { return {}; }
#endif
#ifndef LENDULET_BENCH_CCD
void add_ccd_subjects(PairSubjects&) {}
#endif
#ifndef LENDULET_BENCH_FCL
void add_fcl_subjects(PairSubjects&) {}
#endif

}  // namespace lendulet::bench
