// Parallel searches for pairs whose output does not depend on who ran what: the work is cut into chunks by its size
// alone, each chunk writes to its own list, and the lists are joined in the order of the chunks.
//
// Workers never allocate: the user's allocator hook is called on the thread that steps the world only. A chunk whose
// list is too small counts what it could not write, and is searched again after the list has been made larger.
#pragma once

#include <type_traits>

#include "base/memory.h"
#include "base/tasks.h"
#include "broad_phase/box.h"

namespace lendulet {

// Where a search writes its pairs.
class PairList {
public:
    // Most pairs that one PairWriter may write: eight boxes against eight.
    static constexpr size_t most_at_once = 64;

    PairList(Array<BoxPair>& pairs, bool may_grow) : pairs_(pairs), may_grow_(may_grow) {}
    // One pair, for searches that find few.
    void add(const BoxPair& pair) {
        if (may_grow_ || pairs_.size() < pairs_.capacity()) pairs_.push_back(pair);
        else ++missing_;
    }
    // Pairs found for which there was no room.
    size_t missing() const { return missing_; }

private:
    friend class PairWriter;
    friend class PairRoom;
    Array<BoxPair>& pairs_;
    bool may_grow_;
    size_t missing_ = 0;
    BoxPair overflow_[most_at_once];
};

// Writes up to `most` pairs to a list without a check per pair.
class PairWriter {
public:
    PairWriter(PairList& list, size_t most) : list_(list) {
        Array<BoxPair>& pairs = list.pairs_;
        LENDULET_ASSERT(most <= PairList::most_at_once);
        bool room = pairs.capacity() - pairs.size() >= most;
        if (!room && list.may_grow_) {
            pairs.reserve(pairs.size() + most);
            room = true;
        }
        begin_ = next_ = room ? pairs.data() + pairs.size() : list.overflow_;
    }
    ~PairWriter() {
        size_t written = static_cast<size_t>(next_ - begin_);
        if (begin_ == list_.overflow_) list_.missing_ += written;
        else list_.pairs_.resize_unset(list_.pairs_.size() + written);
    }
    PairWriter(const PairWriter&) = delete;
    PairWriter& operator=(const PairWriter&) = delete;

    void write(uint32_t a, uint32_t b) { *next_++ = a < b ? BoxPair{a, b} : BoxPair{b, a}; }
    void write_as_it_is(uint32_t a, uint32_t b) { *next_++ = {a, b}; }

private:
    PairList& list_;
    BoxPair *begin_, *next_;
};

// What a search for single boxes calls with the index of each that it meets. One type for all of them, so that each
// structure has its search once.
class Meetings {
public:
    // Appends the indices.
    explicit Meetings(Array<uint32_t>& indices) : indices_(&indices) {}
    // Appends pairs of a number with each: as they are, or the smaller index first.
    Meetings(PairList& pairs, uint32_t own, bool sorted) : pairs_(&pairs), own_(own), sorted_(sorted) {}

    void operator()(uint32_t index) const;

private:
    Array<uint32_t>* indices_ = nullptr;
    PairList* pairs_ = nullptr;
    uint32_t own_ = 0;
    bool sorted_ = false;
};

inline void Meetings::operator()(uint32_t index) const {
    if (indices_) {
        indices_->push_back(index);
        return;
    }
    const bool turned = sorted_ && index < own_;
    pairs_->add(turned ? BoxPair{index, own_} : BoxPair{own_, index});
}

// Where a kernel writes pairs without knowing of lists: from `next` on there is room for most_at_once pairs, or `full`
// has to be called before they are written. Plain data: kernels are compiled for several instruction sets.
struct PairStream {
    BoxPair *next, *end;
    void (*full)(PairStream&);
};

// The stream of a list.
class PairRoom : public PairStream {
public:
    explicit PairRoom(PairList& list) : list_(list) {
        full = [](PairStream& stream) {
            static_cast<PairRoom&>(stream).take_over();
            static_cast<PairRoom&>(stream).open();
        };
        open();
    }
    ~PairRoom() { take_over(); }
    PairRoom(const PairRoom&) = delete;
    PairRoom& operator=(const PairRoom&) = delete;

private:
    void open() {
        Array<BoxPair>& pairs = list_.pairs_;
        bool room = pairs.capacity() - pairs.size() >= PairList::most_at_once;
        if (!room && list_.may_grow_) {
            pairs.reserve(pairs.size() + PairList::most_at_once);
            room = true;
        }
        begin_ = next = room ? pairs.data() + pairs.size() : list_.overflow_;
        end = room ? pairs.data() + pairs.capacity() : list_.overflow_ + PairList::most_at_once;
    }
    void take_over() {
        size_t written = static_cast<size_t>(next - begin_);
        if (begin_ == list_.overflow_) list_.missing_ += written;
        else list_.pairs_.resize_unset(list_.pairs_.size() + written);
    }

    PairList& list_;
    BoxPair* begin_;
};

class PairChunks {
public:
    explicit PairChunks(const Memory* memory) {
        for (Chunk& chunk : chunks_) chunk.pairs.set_memory(memory);
    }

    // body(begin, end, list) appends the pairs of the work items [begin, end) to `list`, item after item: two calls for
    // the halves of a range must append what one call for the whole does. Chunks have at least `grain` items.
    template <class Body>
    void search(TaskPool& tasks, int count, int grain, Array<BoxPair>& out, Body&& body) {
        using Plain = std::remove_reference_t<Body>;
        void (*const run)(void*, int, int, PairList&) = [](void* context, int begin, int end, PairList& list) {
            (*static_cast<Plain*>(context))(begin, end, list);
        };
        if (count <= 0) return;
        if (tasks.workers() == 1 || count <= grain) {  // the same items in the same order
            PairList list(out, true);
            return run(&body, 0, count, list);
        }
        search_in_chunks(tasks, count, grain, out, {&body, run});
    }

    size_t bytes() const {
        size_t sum = 0;
        for (const Chunk& chunk : chunks_) sum += chunk.pairs.bytes();
        return sum;
    }

private:
    static constexpr int max_chunks = 64;  // enough to balance 16 workers; more would only scatter the memory
    struct alignas(64) Chunk {             // one cache line each: neighbours are written by different threads
        Array<BoxPair> pairs;
        size_t missing = 0;
        bool done = false;
    };

    struct Body {
        void* context;
        void (*run)(void* context, int begin, int end, PairList& list);
    };
    void search_in_chunks(TaskPool& tasks, int count, int grain, Array<BoxPair>& out, Body body);
    bool make_room(int chunks);

    Chunk chunks_[max_chunks];
};

}  // namespace lendulet
