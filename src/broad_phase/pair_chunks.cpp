#include "broad_phase/pair_chunks.h"

namespace lendulet {

void PairChunks::search_in_chunks(TaskPool& tasks, int count, int grain, Array<BoxPair>& out, Body body) {
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
                body.run(body.context, begin, end, list);
                chunks_[c].missing = list.missing();
                chunks_[c].done = true;
            }
        });
        again = make_room(chunks);
    }
    for (int c = 0; c < chunks; ++c) out.append(chunks_[c].pairs.data(), chunks_[c].pairs.size());
}

// Enlarges the lists that were too small, so that the next search of their chunks fits; a quarter more than needed,
// because the number of pairs goes up and down. False where all fitted.
bool PairChunks::make_room(int chunks) {
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

}  // namespace lendulet
