// Parallel searches for pairs whose output does not depend on who ran what: the work is cut into chunks by its size
// alone, each chunk writes to its own list, and the lists are joined in the order of the chunks.
//
// Workers never allocate: the user's allocator hook is called on the thread that steps the world only. A chunk whose
// list is too small counts what it could not write, and is searched again after the list has been made larger.
#pragma once

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
        if (count <= 0) return;
        if (tasks.workers() == 1 || count <= grain) {  // the same items in the same order
            PairList list(out, true);
            return body(0, count, list);
        }
        int step = (count + max_chunks - 1) / max_chunks;
        step = step < grain ? grain : step;
        int chunks = (count + step - 1) / step;
        for (int c = 0; c < chunks; ++c) chunks_[c].done = false;
        for (bool again = true; again;) {
            tasks.for_each(chunks, 1, [&](int first, int last, int) {
                for (int c = first; c < last; ++c) {
                    if (chunks_[c].done) continue;
                    int begin = c * step, end = count - begin < step ? count : begin + step;
                    chunks_[c].pairs.clear();
                    PairList list(chunks_[c].pairs, false);
                    body(begin, end, list);
                    chunks_[c].missing = list.missing();
                    chunks_[c].done = true;
                }
            });
            again = make_room(chunks);
        }
        for (int c = 0; c < chunks; ++c) out.append(chunks_[c].pairs.data(), chunks_[c].pairs.size());
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

    // Enlarges the lists that were too small, so that the next search of their chunks fits; a quarter more than needed,
    // because the number of pairs goes up and down. False where all fitted.
    bool make_room(int chunks) {
        bool any = false;
        for (int c = 0; c < chunks; ++c) {
            Chunk& chunk = chunks_[c];
            if (chunk.missing == 0) continue;
            size_t needed = chunk.pairs.size() + chunk.missing;
            chunk.pairs.reserve(needed + needed / 4 + PairList::most_at_once);
            chunk.done = false;
            any = true;
        }
        return any;
    }

    Chunk chunks_[max_chunks];
};

}  // namespace lendulet
