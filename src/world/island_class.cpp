#include "world/island_class.h"

#include "solver/solver.h"

namespace lendulet {
namespace {

// Contacts of an island, times its multiple of substeps, at most: against buckling and for gaps of joints, and against
// sinking alone, by which nothing falls.
constexpr int most_contacts = 1024, most_sinking = 512;
constexpr float allowed_sinking = 1e-3f;  // of the size of the bodies
constexpr float buckling_reserve = 1.7f;  // above the load at which a column of boxes was seen to buckle
constexpr float kept_reserve = 1.6f;  // a class is left only when fewer substeps would carry this many times the load
constexpr int patience = 60;          // ... for so many steps: a column that has just stiffened springs up a little
constexpr int falling_patience = 12;  // ... and for so many where all bodies are fast, or none carries anything
constexpr int loose_patience = 3;     // ... and for so many where most contacts move
constexpr int fewest_loose = 32;      // contacts of an island of which that is asked
// Steps for which a load must be felt before an island takes more substeps for it: what lands on bodies that lie still
// presses them for a step or two, and so does what rocks. Of 200 bodies that jump about, two thirds took two or four
// times the substeps with 1, half of them with 2, none with 3.
constexpr int lasting_load = 3;
// An island flows from so many contacts on (fewer cost little), by no fewer substeps than these, and while what is slow
// in it sinks by no more than this part of its size, on average.
constexpr int fewest_contacts = 256, fewest_substeps = 4;
constexpr float flowing_sinking = 4e-3f;

struct Load {
    float sinking, buckling;
};

// How far a contact sinks that carries once the weight of its lighter body, of two free ones.
float sinking_of(float gravity, float h) { return 2.0f * (contact_leak / contact_bias) * gravity * h * h; }

// The least class of which the square of the substeps is at least `needed`, or the most that so many contacts may take.
int class_of_square(float needed, int substeps, int contacts, int most) {
    int c = 0;
    for (float n = static_cast<float>(substeps); c + 1 < substep_classes && n * n < needed; n *= 2.0f) ++c;
    while (c > 0 && (contacts << c) > most) --c;
    return c;
}

int larger(int a, int b) { return a > b ? a : b; }

// The least class whose substeps carry `times` this load.
int class_for(const IslandLoad& l, Load load, float gravity, float dt, int substeps, float times) {
    const float height = (l.highest - l.lowest) / gravity;
    const float drop = times * gravity * dt * dt * (contact_leak / contact_bias);
    const float sinking = drop * (2.0f / allowed_sinking) * load.sinking;
    const float buckling = drop * buckling_reserve * load.buckling * height * height;
    return larger(class_of_square(sinking, substeps, l.contacts, l.jointed ? most_contacts : most_sinking),
                  class_of_square(buckling, substeps, l.contacts, most_contacts));
}

// Whether an island of many bodies moves in most places: nothing stands there.
bool is_loose(const IslandLoad& l) { return !l.jointed && l.contacts >= fewest_loose && 2 * l.stirred > l.samples; }

// What rests leaves most of its substeps out, however many they are; to go on with fewer it would have to sink first.
bool rests_cheaply(const IslandLoad& l) { return l.still && l.rests && !l.jointed; }

// Whether half of the substeps do for what is loose.
bool can_flow(const IslandLoad& l, float gravity, float dt, int substeps) {
    if (l.contacts < fewest_contacts || !(gravity > 0.0f) || substeps % 2 != 0 || substeps < 2 * fewest_substeps)
        return false;
    const float h = 2.0f * dt / static_cast<float>(substeps);
    return sinking_of(gravity, h) * l.sampled_sinking < flowing_sinking * static_cast<float>(l.samples);
}

}  // namespace

void decide_substeps(IslandLoad& l, float gravity, float dt, int substeps) {
    l.decided = true;
    const bool loose = is_loose(l);
    l.flows = loose && can_flow(l, gravity, dt, substeps);
    if (l.tied) return;
    int c = l.least;
    if (gravity > 0.0f) {
        int kept = l.before;
        const Load known{l.sinking, l.buckling}, felt{l.felt_sinking, l.felt_buckling};
        const Load all{maximum(known.sinking, felt.sinking), maximum(known.buckling, felt.buckling)};
        if (!loose) c = larger(c, class_for(l, known, gravity, dt, substeps, 1.0f));
        const int asked = loose ? 0 : class_for(l, felt, gravity, dt, substeps, 1.0f);
        l.pressed = asked > larger(kept, c) ? static_cast<uint8_t>(l.pressed + 1) : uint8_t{0};
        if (l.pressed >= lasting_load) c = asked, l.pressed = 0;
        bool bearable = kept > 0 && (loose || class_for(l, all, gravity, dt, substeps, kept_reserve) < kept);
        bearable &= !rests_cheaply(l);
        l.waited = bearable ? static_cast<uint8_t>(l.waited + 1) : uint8_t{0};
        const bool stands = l.rests && all.sinking > 0.0f;
        if (l.waited >= (loose ? loose_patience : stands ? patience : falling_patience)) --kept, l.waited = 0;
        c = larger(c, kept);
    }
    while (c > 0 && (l.contacts << c) > most_contacts) --c;
    l.substeps = static_cast<uint8_t>(c);
    l.flows &= c == 0;
}

}  // namespace lendulet
