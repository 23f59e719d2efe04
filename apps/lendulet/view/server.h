// The viewer's page and its stream of a native world, for browsers on this machine alone.
//
// Listens on 127.0.0.1. Whoever asks under another name of this host is refused (so that no foreign page gets in by a
// name of its own that leads here), and a stream is opened only for pages from this very server: the Origin that
// browsers send must be ours.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "apps/lendulet/view/session.h"

namespace lendulet::cli {

struct ServerOptions {
    uint16_t port = 8080;                      // 0: any that is free
    std::string folder;                        // of the page
    std::string head;                          // put into the page's <head>
    std::string recording;                     // bytes, served as "recording"; empty: none
    std::map<std::string, std::string> files;  // what else is served: paths by the names under which it is asked for
    double give_up = 0.0;                      // s without any connection after which it ends; 0: never
    bool any_port = false;                     // another port where that one is taken
};

// Serves until it is interrupted or gives up. `ready(port)` is called once it listens, before anyone is answered.
// Errors: io (the port is taken).
Status serve(const ServerOptions& options, const OpenScene& open, const std::function<void(uint16_t port)>& ready);

}  // namespace lendulet::cli
