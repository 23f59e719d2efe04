// Assertions are for our own bugs only: never for the caller's data. They are off in release builds.
#pragma once

#ifdef LENDULET_ASSERTIONS
namespace lendulet::detail {
[[noreturn]] void assertion_failed(const char* expression, const char* file, int line);
}
#define LENDULET_ASSERT(x) ((x) ? (void)0 : ::lendulet::detail::assertion_failed(#x, __FILE__, __LINE__))
#else
#define LENDULET_ASSERT(x) ((void)0)
#endif
