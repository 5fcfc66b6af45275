// Freed memory goes back to the system.
#pragma once

#include <cstdlib>
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace gaussdrift::base {

/// glibc keeps freed blocks of up to 32 MB for later ones. Where a process is about to take blocks of other sizes they
/// count twice.
inline void return_memory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

}  // namespace gaussdrift::base
