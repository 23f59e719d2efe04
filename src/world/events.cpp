// Events: what a step notes for them, and the lists that are made of it when it is over.
#include "world/events.h"

#include <algorithm>

#include "world/continuous_path.h"
#include "world/validate.h"
#include "world/world_data.h"

namespace lendulet {
namespace {

// Two that touch go on to do so until they are this far apart, in parts of the smaller one's radius: what rests in a
// heap loses its load and finds it again, at gaps of up to a ten-thousandth.
constexpr float parted = 1e-3f;

bool asks_for(uint8_t asks, Events what) { return (asks & static_cast<uint8_t>(what)) != 0; }

// visit(pair, asks) for the listed pairs of which either collider asks, in order.
template <class Visit>
void for_each_asked(WorldData& world, Visit&& visit) {
    const uint8_t* asks = world.events.asks.data();
    for (const ListedPair& l : world.pairs.listed) {
        const auto both = static_cast<uint8_t>(asks[l.a] | asks[l.b]);
        if (both != 0) visit(world.pairs.pairs[l.pair], both);
    }
}

ContactEvent event_of(const WorldData& world, const ColliderPair& p) {
    const ColliderStore& c = world.colliders;
    return {world.bodies.id(c.info[p.a].body), world.bodies.id(c.info[p.b].body), c.id(p.a), c.id(p.b)};
}

// Whether the bodies of a pair were moved in this step: its contacts were solved.
bool was_solved(const WorldData& world, const ColliderPair& p) {
    const BodyInfo& b = world.bodies.info[p.body_b];
    return b.type == BodyType::dynamic && !b.asleep;
}

int part_of(const WorldData& world, const ColliderPair& p) {
    int part = 0;
    while (world.bodies.info[p.body_b].solver_index >= world.parts[part].bodies.end) ++part;
    return part;
}

uint64_t key(uint32_t a, uint32_t b) { return uint64_t{a} << 32 | b; }
template <class Event>
bool precedes(const Event& x, const Event& y) {
    const uint64_t kx = key(x.collider_a.index, x.collider_b.index), ky = key(y.collider_a.index, y.collider_b.index);
    if (kx != ky) return kx < ky;
    return key(x.collider_a.generation, x.collider_b.generation) <
           key(y.collider_a.generation, y.collider_b.generation);
}
bool precedes_overlap(const Overlap& x, const Overlap& y) {
    auto pair = [](const Overlap& o) {
        const bool first = o.trigger.index < o.other.index;
        return ContactEvent{{}, {}, first ? o.trigger : o.other, first ? o.other : o.trigger};
    };
    return precedes(pair(x), pair(y));
}

// What a pair did in this step.
struct PairStep {
    float gap = far_separation;  // least separation of its points at the end, m
    float carried = 0.0f;        // within it, along the normal, N s
    bool carries = false;        // at the end
    const WatchedContact* fastest = nullptr;
    bool unanswered = false;
};

PairStep step_of(const WorldData& world, const ColliderPair& p) {
    PairStep s;
    for (uint32_t i = p.first_record; i < p.first_record + p.count; ++i) {
        const ContactRecord& r = world.records[i];
        for (int j = 0; j < r.point_count; ++j) {
            s.gap = minimum(s.gap, r.points[j].separation);
            s.carries |= r.normal_impulse[j] > 0.0f;
        }
        const uint32_t watch = world.events.watch_of_record[i];
        if (watch == 0) continue;
        const WatchedContact& w = world.events.watched[watch - 1];
        s.carried += w.impulse;
        s.unanswered |= w.unanswered;
        if (w.speed > (s.fastest ? s.fastest->speed : 0.0f)) s.fastest = &w;
    }
    return s;
}

ContactHit hit_of(const WorldData& world, const ColliderPair& p, const PairStep& s) {
    const ContactEvent e = event_of(world, p);
    const Position start = world.continuous.start[place_of(world, p.body_b)].position;
    return {e.body_a,
            e.body_b,
            e.collider_a,
            e.collider_b,
            start + s.fastest->place_of_hit,
            p.flipped ? -s.fastest->normal : s.fastest->normal,
            s.fastest->speed,
            s.carried};
}

// The pending hit of a pair among the first `count`, or null.
ContactHit* find_pending(Array<ContactHit>& list, int count, const ContactEvent& pair) {
    ContactHit* end = list.begin() + count;
    ContactHit* at = std::lower_bound(list.begin(), end, pair, [](const ContactHit& x, const ContactEvent& y) {
        return precedes(ContactEvent{{}, {}, x.collider_a, x.collider_b}, y);
    });
    return at != end && at->collider_a == pair.collider_a && at->collider_b == pair.collider_b ? at : nullptr;
}

// Hits of the last step that were not over with it, as they are looked up and taken.
class PendingHits {
public:
    explicit PendingHits(Array<ContactHit>& list) : list_(list), given_(list.count()) {}
    // Joins a hit with what was pending of the same pair; false where nothing was.
    bool join(const ContactEvent& pair, const ContactHit* now, float carried, Array<ContactHit>& out) {
        ContactHit* before = find_pending(list_, given_, pair);
        if (!before) return false;
        ContactHit whole = now && now->speed > before->speed ? *now : *before;
        whole.impulse = before->impulse + carried;
        out.push_back(whole);
        before->speed = 0.0f;  // taken
        return true;
    }
    void keep(const ContactHit& hit) { list_.push_back(hit); }
    // Those of pairs that are not solved any more, as they are.
    bool release(Array<ContactHit>& out) {
        bool any = false;
        size_t kept = 0;
        for (int i = 0; i < given_; ++i)
            if (list_[static_cast<size_t>(i)].speed > 0.0f) out.push_back(list_[static_cast<size_t>(i)]), any = true;
        for (auto i = static_cast<size_t>(given_); i < list_.size(); ++i) list_[kept++] = list_[i];
        list_.resize_unset(kept);
        return any;
    }

private:
    Array<ContactHit>& list_;
    int given_;
};

void report_hit(WorldData& world, const ColliderPair& p, const PairStep& s, PendingHits& pending) {
    EventData& e = world.events;
    ContactHit now{};
    if (s.fastest) now = hit_of(world, p, s);
    // What is not finite was contained, and is nothing to tell of.
    const bool finite = is_finite(from_origin(now.position)) && is_finite(now.normal) && is_finite(now.impulse);
    const bool hits = s.fastest && finite && now.speed >= world.config.hit_speed;
    if (pending.join(event_of(world, p), hits ? &now : nullptr, s.carried, e.hits) || !hits) return;
    if (s.unanswered) pending.keep(now);
    else e.hits.push_back(now);
}

Overlap overlap_of(const ContactEvent& pair, bool trigger_first) {
    return trigger_first ? Overlap{pair.body_a, pair.body_b, pair.collider_a, pair.collider_b}
                         : Overlap{pair.body_b, pair.body_a, pair.collider_b, pair.collider_a};
}

void report_trigger(WorldData& world, ColliderPair& p, uint8_t asks) {
    if (p.hit == p.touches) return;
    p.touches = p.hit;
    if (!asks_for(asks, Events::contacts)) return;
    const Overlap o = overlap_of(event_of(world, p), world.colliders.info[p.a].is_trigger);
    (p.hit ? world.events.trigger_begins : world.events.trigger_ends).push_back(o);
}

void report_contact(WorldData& world, ColliderPair& p, uint8_t asks, PendingHits& pending) {
    if (!was_solved(world, p)) return;
    EventData& e = world.events;
    const PairStep s = step_of(world, p);
    const ColliderStore& c = world.colliders;
    const float reach = parted * minimum(c.info[p.a].radius, c.info[p.b].radius);
    const bool met = s.gap <= 0.0f || s.carried > 0.0f;
    const bool touches = s.carries || s.gap <= (met || p.touches ? reach : 0.0f);
    if (asks_for(asks, Events::contacts)) {
        if (met && !p.touches) e.begins.push_back(event_of(world, p));
        if ((met || p.touches) && !touches) e.ends.push_back(event_of(world, p));
    }
    p.touches = touches;
    if (asks_for(asks, Events::hits)) report_hit(world, p, s, pending);
}

// Few events come out of order. By a heap, which takes a third of the code that std::sort does.
template <class T, class Precedes>
void sort_from(Array<T>& list, size_t first, Precedes precedes) {
    std::make_heap(list.begin() + first, list.end(), precedes);  // order: total
    std::sort_heap(list.begin() + first, list.end(), precedes);  // order: total
}

void report_sleep(WorldData& world) {
    EventData& e = world.events;
    if (e.woken.empty() && e.fallen.empty()) return;
    std::sort(e.woken.begin(), e.woken.end());  // order: total
    for (uint32_t slot : e.woken) {
        bool& woken = world.bodies.info[slot].woken;
        if (woken) e.sleeps.push_back({world.bodies.id(slot), false});
        woken = false;
    }
    std::sort(e.fallen.begin(), e.fallen.end());  // order: total
    for (uint32_t slot : e.fallen) e.sleeps.push_back({world.bodies.id(slot), true});
    e.woken.clear(), e.fallen.clear();
}

}  // namespace

void set_asks(WorldData& world, uint32_t collider, Events events) {
    EventData& e = world.events;
    e.asks.resize(world.colliders.slots.capacity(), 0);
    world.colliders.info[collider].events = events;
    e.askers += int{events != Events::none} - int{e.asks[collider] != 0};
    e.asks[collider] = static_cast<uint8_t>(events);
}

void note_ended(WorldData& world, const ColliderPair& p) {
    if (!p.touches) return;
    const EventData& e = world.events;
    if (!asks_for(static_cast<uint8_t>(e.asks[p.a] | e.asks[p.b]), Events::contacts)) return;
    const bool trigger = p.kind == PairKind::trigger, first = trigger && world.colliders.info[p.a].is_trigger;
    ContactEvent pair = event_of(world, p);
    if (trigger && !first) std::swap(pair.body_a, pair.body_b), std::swap(pair.collider_a, pair.collider_b);
    world.events.ended.push_back({pair, trigger});
}

void note_woken(WorldData& world, uint32_t slot) {
    BodyInfo& info = world.bodies.info[slot];
    if (!info.asleep || info.woken) return;
    info.woken = true;
    world.events.woken.push_back(slot);
}

void clear_events(EventData& e) {
    e.begins.clear(), e.ends.clear(), e.hits.clear();
    e.trigger_begins.clear(), e.trigger_ends.clear();
    e.sleeps.clear();
    e.breaks.clear();
}

void watch_contacts(WorldData& world) {
    EventData& e = world.events;
    for (const WatchedContact& w : e.watched) e.watch_of_record[w.record] = 0;
    e.watched.clear();
    for (Solver& solver : world.solvers) solver.watch({});
    if (e.askers == 0) return;
    e.watch_of_record.resize(world.records.size(), 0);
    // Of those that touch and are not asked for hits all is to be seen at the end of the step.
    auto watched = [&](const ColliderPair& p, uint8_t asks) {
        return p.count > 0 && was_solved(world, p) && (asks_for(asks, Events::hits) || !p.touches);
    };
    int counts[solver_parts] = {}, ends[solver_parts], total = 0;
    for_each_asked(world, [&](const ColliderPair& p, uint8_t asks) {
        if (watched(p, asks)) counts[part_of(world, p)] += p.count;
    });
    for (int c = 0; c < solver_parts; ++c) ends[c] = total, total += counts[c];
    if (total == 0) return;
    e.watched.resize_unset(static_cast<size_t>(total));
    for_each_asked(world, [&](const ColliderPair& p, uint8_t asks) {
        if (!watched(p, asks)) return;
        int& end = ends[part_of(world, p)];
        WatchedContact w;
        w.speeds = asks_for(asks, Events::hits);
        w.follows =
            !p.touches || (!e.pending.empty() && find_pending(e.pending, e.pending.count(), event_of(world, p)));
        for (w.record = p.first_record; w.record < p.first_record + p.count; ++w.record) {
            e.watched[static_cast<size_t>(end)] = w;
            e.watch_of_record[w.record] = static_cast<uint32_t>(++end);
        }
    });
    for (int c = 0; c < solver_parts; ++c)
        world.solvers[c].watch(
            {e.watched.data(), e.watch_of_record.data(), ends[c] - counts[c], counts[c], world.config.hit_speed});
}

void report_events(WorldData& world) {
    EventData& e = world.events;
    report_sleep(world);
    if (e.askers == 0 && e.ended.empty() && e.pending.empty()) return;
    const size_t ends = e.ends.size(), hits = e.hits.size(), trigger_ends = e.trigger_ends.size();
    PendingHits pending(e.pending);
    if (e.askers > 0)
        for_each_asked(world, [&](ColliderPair& p, uint8_t asks) {
            if (p.kind == PairKind::trigger) report_trigger(world, p, asks);
            else report_contact(world, p, asks, pending);
        });
    if (pending.release(e.hits)) sort_from(e.hits, hits, precedes<ContactHit>);
    for (const EndedTouch& x : e.ended) {
        if (x.trigger) e.trigger_ends.push_back(overlap_of(x.pair, true));
        else e.ends.push_back(x.pair);
    }
    if (!e.ended.empty()) {
        sort_from(e.ends, ends, precedes<ContactEvent>);
        sort_from(e.trigger_ends, trigger_ends, precedes_overlap);
    }
    e.ended.clear();
}

namespace {
template <class T>
std::span<const T> all_of(const Array<T>& list) {
    return {list.data(), list.size()};
}
}  // namespace

std::span<const ContactEvent> World::contact_begins() const { return all_of(data().events.begins); }
std::span<const ContactEvent> World::contact_ends() const { return all_of(data().events.ends); }
std::span<const ContactHit> World::contact_hits() const { return all_of(data().events.hits); }
std::span<const Overlap> World::trigger_begins() const { return all_of(data().events.trigger_begins); }
std::span<const Overlap> World::trigger_ends() const { return all_of(data().events.trigger_ends); }
std::span<const SleepEvent> World::sleep_events() const { return all_of(data().events.sleeps); }

std::span<const JointBreak> World::joint_breaks() const { return all_of(data().events.breaks); }

}  // namespace lendulet
