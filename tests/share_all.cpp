// The worlds of tests are small, and would be stepped by one thread however many they are given.
#include "base/tasks.h"

namespace lendulet {
namespace {

[[maybe_unused]] const bool all_is_shared = TaskPool::shares_all = true;

}  // namespace
}  // namespace lendulet
