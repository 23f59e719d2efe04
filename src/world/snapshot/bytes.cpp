// A saved state as bytes: little-endian, without padding; what is at rest or absent takes a bit. One function for each
// kind of object goes through its fields, for writing and for reading.
//
// The bytes begin with "LENDSNAP", a version and their number, and end with a checksum, so that truncated and altered
// ones are told from good ones before anything is read from them.
#include <bit>
#include <cstring>

#include "base/hash.h"
#include "world/snapshot/saved_state.h"
#include "world/validate.h"

namespace lendulet {
namespace {

static_assert(std::endian::native == std::endian::little);
constexpr char magic[8] = {'L', 'E', 'N', 'D', 'S', 'N', 'A', 'P'};
constexpr uint32_t version = 10;
constexpr size_t header_bytes = sizeof magic + 2 * sizeof(uint32_t), checksum_bytes = sizeof(uint64_t);

uint64_t checksum(std::span<const uint8_t> bytes) {
    uint64_t hash = bytes.size();
    for (size_t i = 0; i < bytes.size(); i += sizeof(uint64_t)) {
        uint64_t word = 0;
        std::memcpy(&word, bytes.data() + i, bytes.size() - i < sizeof word ? bytes.size() - i : sizeof word);
        hash = hash_combine(hash, word);
    }
    return hash;
}

class Writer {
public:
    static constexpr bool reading = false;
    template <class... T>
    void operator()(T&... values) {
        (put(&values, sizeof values), ...);
    }
    template <class T, class Fields>
    void list(Array<T>& list, Fields&& fields) {
        uint32_t count = static_cast<uint32_t>(list.size());
        (*this)(count);
        for (T& item : list) fields(*this, item);
    }
    std::vector<uint8_t> bytes;

private:
    void put(const void* value, size_t size) {
        const auto* p = static_cast<const uint8_t*>(value);
        bytes.insert(bytes.end(), p, p + size);
    }
};

// Gives zeros once the bytes have ended, and remembers that they did.
class Reader {
public:
    static constexpr bool reading = true;
    explicit Reader(std::span<const uint8_t> bytes) : left_(bytes) {}
    template <class... T>
    void operator()(T&... values) {
        (take(&values, sizeof values), ...);
    }
    template <class T, class Fields>
    void list(Array<T>& list, Fields&& fields) {
        uint32_t count = 0;
        (*this)(count);
        if (count > left_.size()) good_ = false;  // every item takes a byte at least
        for (uint32_t i = 0; good_ && i < count; ++i) fields(*this, list.push_back(T{}));
    }
    bool good() const { return good_; }
    bool at_end() const { return left_.empty(); }

private:
    // A page loads the module: there a call takes less room than a hundred copies.
#if defined(__wasm__)
    [[gnu::noinline]]
#endif
    void
    take(void* value, size_t size) {
        if (size > left_.size()) good_ = false;
        if (!good_) {
            std::memset(value, 0, size);
            return;
        }
        std::memcpy(value, left_.data(), size);
        left_ = left_.subspan(size);
    }
    std::span<const uint8_t> left_;
    bool good_ = true;
};

// Up to eight bools as one byte.
template <class Bytes, class... Flag>
void flags(Bytes& bytes, Flag&... flag) {
    static_assert(sizeof...(Flag) <= 8);
    uint8_t packed = 0;
    int bit = 0;
    ((packed |= static_cast<uint8_t>(flag ? 1 << bit : 0), ++bit), ...);
    bytes(packed);
    bit = 0;
    ((flag = (packed >> bit & 1) != 0, ++bit), ...);
}

template <class Bytes>
void slots(Bytes& bytes, SavedSlots& s) {
    bytes(s.count, s.capacity);
    bytes.list(s.free_list, [](Bytes& b, uint32_t& slot) { b(slot); });
}

// Most objects stand in the slot after that of the one before, used as often.
template <class Saved>
void note_followers(Array<Saved>& list) {
    SlotUse next{0, 0};
    for (Saved& s : list) {
        s.follows = s.id == next;
        next = {s.id.slot + 1, s.id.uses};
    }
}
template <class Saved>
void number_followers(Array<Saved>& list) {
    SlotUse next{0, 0};
    for (Saved& s : list) {
        if (s.follows) s.id = next;
        next = {s.id.slot + 1, s.id.uses};
    }
}

template <class Bytes>
void body(Bytes& bytes, SavedBody& b) {
    flags(bytes, b.asleep, b.has_forces, b.placed, b.capped, b.contained, b.stopped, b.loaded, b.fixed);
    if (b.fixed) {
        flags(bytes, b.altered, b.follows);
        if (!b.follows) bytes(b.id);
        if (b.altered) bytes(b.pose);
        return;
    }
    flags(bytes, b.mover, b.woken, b.bullet, b.allow_sleep, b.drags_alike, b.kinematic, b.altered, b.follows);
    if (!b.follows) bytes(b.id);
    if (b.altered) bytes(b.mass.mass, b.mass.inverse_mass, b.mass.inertia, b.mass.inverse_inertia, b.mass.anisotropy);
    if (!b.drags_alike) bytes(b.linear_damping, b.angular_damping, b.gravity_factor);
    bytes(b.pose, b.still_time);
    if (b.asleep) bytes(b.momenta.x_low, b.momenta.turn_low);
    else bytes(b.momenta, b.change);
    if (b.has_forces) bytes(b.forces);
    if (b.loaded) bytes(b.substeps, b.waited, b.calm);
}

template <class Bytes>
void drive(Bytes& bytes, Motor& m, Spring& s) {
    bytes(m.target_velocity, m.max_force);
    bytes(s.stiffness, s.damping, s.target, s.max_force, s.target_velocity);
}

template <class Bytes>
void maybe(Bytes& bytes, std::optional<float>& x) {
    bool there = x.has_value();
    float value = x.value_or(0.0f);
    flags(bytes, there);
    if (there) bytes(value);
    x = there ? std::optional<float>(value) : std::nullopt;
}

template <class Bytes>
void collider(Bytes& bytes, SavedCollider& c) {
    bytes(c.filter.category, c.filter.mask, c.filter.group, c.events);
    Material& m = c.material;
    maybe(bytes, m.static_friction), maybe(bytes, m.dynamic_friction), maybe(bytes, m.restitution);
    bytes(m.rolling_friction, m.spinning_friction, m.tangential_restitution, m.surface_velocity);
    bytes(m.friction_combine, m.restitution_combine);
}

template <class Bytes>
void joint(Bytes& bytes, SavedJoint& j) {
    JointImpulses& i = j.impulses;
    drive(bytes, j.motor, j.spring);
    bytes(j.limit, j.twist_limit, j.swing_limit, j.friction);
    bytes(i.linear, i.angular, i.limit, i.motor, i.spring, i.flags);
    bytes(i.impulse, i.angular_impulse, i.h);
    flags(bytes, j.has_axes, j.follows);
    if (!j.follows) bytes(j.id);
    if (!j.has_axes) return;
    for (JointAxis& axis : j.axes.row) drive(bytes, axis.motor, axis.spring), bytes(axis.limit, axis.friction);
    bytes(j.axes.limit, j.axes.motor, j.axes.spring);
}

template <class Bytes>
void pair(Bytes& bytes, SavedPair& p) {
    bool cached = p.cache.feature != 0 || p.cache.clearance != 0.0f || p.cache.gjk.count > 0;
    flags(bytes, p.hit, p.begun, p.kept, cached, p.listed, p.touches);
    bytes(p.a, p.b, p.contacts);
    if (!p.listed) bytes(p.rest_h);
    if (cached) {
        GjkCache& g = p.cache.gjk;
        bytes(p.cache.feature, p.cache.clearance, g.count, g.face);
        if (g.count > 0) bytes(g.direction);
        for (int k = 0; k < g.count && k < 4; ++k) bytes(g.a[k], g.b[k]);
    }
    KeptPose& k = p.pose;
    if (p.kept) bytes(k.rotation_a, k.rotation_b, k.offset, k.tolerance, k.clearance, k.feature);
}

// Friction and bounciness follow from the colliders; what stands of absent points does not matter.
template <class Bytes>
void contact(Bytes& bytes, SavedContact& c) {
    ContactRecord& r = c.record;
    uint8_t points = static_cast<uint8_t>(r.point_count);
    bytes(points);
    r.point_count = points;
    bytes(r.normal, r.friction_impulse, r.twist_impulse, r.radius_a, r.radius_b, r.follow, r.arm_offset, r.key,
          r.triangle);
    flags(bytes, c.rolls, c.fresh, c.covered);
    if (c.rolls) bytes(c.extra.impulse, c.extra.h);
    for (int j = 0; j < 4; ++j) {
        if (j < points) {
            bytes(r.points[j], r.normal_impulse[j], r.id[j], c.found.s[j]);
        } else if (Bytes::reading) {
            r.points[j] = {{}, far_separation};
            c.found.s[j] = far_separation;
        }
    }
}

template <class Bytes>
void handle(Bytes& bytes, auto& id) {
    bytes(id.index, id.generation);
}
template <class Bytes>
void handles(Bytes& bytes, auto& event) {
    handle(bytes, event.body_a), handle(bytes, event.body_b);
    handle(bytes, event.collider_a), handle(bytes, event.collider_b);
}
template <class Bytes>
void ended(Bytes& bytes, EndedTouch& e) {
    handles(bytes, e.pair);
    flags(bytes, e.trigger);
}
template <class Bytes>
void hit(Bytes& bytes, ContactHit& h) {
    handles(bytes, h);
    bytes(h.position, h.normal, h.speed, h.impulse);
}

template <class Bytes>
void state(Bytes& bytes, SavedState& s) {
    bytes(s.fingerprint, s.gravity, s.last_h, s.time, s.steps);
    slots(bytes, s.body_slots);
    slots(bytes, s.collider_slots);
    slots(bytes, s.joint_slots);
    bytes.list(s.bodies, body<Bytes>);
    bytes.list(s.joints, joint<Bytes>);
    bytes.list(s.colliders, collider<Bytes>);
    bytes.list(s.alike, [](Bytes& b, uint32_t& count) { b(count); });
    bytes.list(s.boxes, [](Bytes& b, BroadBox& box) { b(box.lower, box.upper, box.index); });
    bytes.list(s.pairs, pair<Bytes>);
    bytes.list(s.contacts, contact<Bytes>);
    bytes.list(s.ended, ended<Bytes>);
    bytes.list(s.pending, hit<Bytes>);
}

Error bad(std::string what) { return {ErrorCode::bad_snapshot, "restore: " + std::move(what)}; }

}  // namespace

std::vector<uint8_t> encode(SavedState& saved) {
    Writer writer;
    writer.bytes.reserve(1024 + 160 * saved.bodies.size() + 80 * saved.pairs.size() + 200 * saved.contacts.size());
    note_followers(saved.bodies), note_followers(saved.joints);
    uint32_t number = version, size = 0;
    writer(magic, number, size);
    state(writer, saved);
    size = static_cast<uint32_t>(writer.bytes.size() + checksum_bytes);
    std::memcpy(writer.bytes.data() + sizeof magic + sizeof number, &size, sizeof size);
    uint64_t sum = checksum(writer.bytes);
    writer(sum);
    return std::move(writer.bytes);
}

Status decode(std::span<const uint8_t> bytes, SavedState& saved) {
    if (bytes.size() < sizeof magic || std::memcmp(bytes.data(), magic, sizeof magic) != 0)
        return bad("these bytes are no snapshot");
    if (bytes.size() < header_bytes + checksum_bytes) return bad("the snapshot ends within its head");
    uint32_t head[2];
    std::memcpy(head, bytes.data() + sizeof magic, sizeof head);
    if (head[0] != version)
        return bad("the snapshot is of version " + std::to_string(head[0]) + ", this engine reads version " +
                   std::to_string(version));
    if (head[1] != bytes.size())
        return bad("the snapshot has " + std::to_string(bytes.size()) + " bytes, should have " +
                   std::to_string(head[1]));
    std::span<const uint8_t> content = bytes.first(bytes.size() - checksum_bytes);
    uint64_t sum;
    std::memcpy(&sum, bytes.data() + content.size(), sizeof sum);
    if (sum != checksum(content)) return bad("the snapshot does not match its checksum");
    Reader reader(content.subspan(header_bytes));
    state(reader, saved);
    if (!reader.good() || !reader.at_end()) return bad("the snapshot's lists do not fit its size");
    number_followers(saved.bodies), number_followers(saved.joints);
    return {};
}

}  // namespace lendulet
