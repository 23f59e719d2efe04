#include "explain/explain.h"

#include <cstdio>

#include "explain/picture.h"
#include "io/file.h"

namespace lendulet::explain {

Result<std::vector<std::string>> draw(const Options& o) {
    Result<Sequence> made = sequence(o.question);
    if (!made) return made.error();
    return documents(o.question.what + ": " + o.question.a + " and " + o.question.b, made.value(), o.frames);
}

Result<int> explain(const Options& o) {
    Result<std::vector<std::string>> drawn = draw(o);
    if (!drawn) return drawn.error();
    const std::string name = o.svg.empty() ? "explain-" + o.question.what + ".svg" : o.svg;
    const size_t dot = name.rfind(".svg");
    const std::string stem = dot == std::string::npos ? name : name.substr(0, dot);
    for (size_t i = 0; i < drawn.value().size(); ++i) {
        const std::string file = o.frames ? stem + "-" + std::to_string(i + 1) + ".svg" : name;
        if (Status written = write_file(file, drawn.value()[i]); !written) return written.error();
        std::printf("%s\n", file.c_str());
    }
    return 0;
}

}  // namespace lendulet::explain
