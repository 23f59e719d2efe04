#include "explain/flat.h"

#include <bit>

namespace lendulet::explain {
namespace {

class Lists {
public:
    void add(const Solid& s) {
        put(solids, {place(points) / 3, size(s.corners), size(indices), size(s.triangles), s.curved ? 1u : 0u});
        add_points(s.corners);
        indices.insert(indices.end(), s.triangles.begin(), s.triangles.end());
    }
    void add(const Step& s) {
        const uint32_t title = add_text(s.title), note = add_text(s.note);
        put(steps, {title, size(s.title), note, size(s.note), place(marks) / mark_words, size(s.marks)});
        for (const Mark& m : s.marks) add(m);
    }
    std::string bytes() {
        text.resize((text.size() + 3) / 4 * 4);
        std::string out;
        append(out, {place(solids) / solid_words, place(steps) / step_words, place(marks) / mark_words,
                     place(points) / 3, size(indices), size(text)});
        for (const std::vector<uint32_t>* list : {&solids, &steps, &marks, &points, &indices}) append(out, *list);
        return out + text;
    }

private:
    static constexpr uint32_t solid_words = 5, step_words = 6, mark_words = 10;
    std::vector<uint32_t> solids, steps, marks, points, indices;
    std::string text;

    template <class List>
    static uint32_t size(const List& list) {
        return static_cast<uint32_t>(list.size());
    }
    static uint32_t place(const std::vector<uint32_t>& list) { return size(list); }
    static void put(std::vector<uint32_t>& list, std::initializer_list<uint32_t> words) {
        list.insert(list.end(), words);
    }
    static void append(std::string& out, const std::vector<uint32_t>& words) {
        out.append(reinterpret_cast<const char*>(words.data()), 4 * words.size());
    }
    static uint32_t word(double x) { return std::bit_cast<uint32_t>(static_cast<float>(x)); }

    void add(const Mark& m) {
        const uint32_t label = add_text(m.label);
        put(marks, {static_cast<uint32_t>(m.kind), static_cast<uint32_t>(m.ink), static_cast<uint32_t>(m.solid),
                    m.faint ? 1u : 0u, place(points) / 3, size(m.points), label, size(m.label), word(m.width),
                    word(m.opacity)});
        add_points(m.points);
    }
    void add_points(const std::vector<Vec>& list) {
        for (const Vec& p : list) put(points, {word(p.x), word(p.y), word(p.z)});
    }
    uint32_t add_text(const std::string& words) {
        text += words;
        return size(text) - size(words);
    }
};

}  // namespace

std::string flat(const Sequence& sequence) {
    Lists lists;
    for (const Solid& s : sequence.solids) lists.add(s);
    for (const Step& s : sequence.steps) lists.add(s);
    return lists.bytes();
}

}  // namespace lendulet::explain
