// Seams of long work: places where it can be abandoned, because somebody has asked for that.
#pragma once

#include <functional>

namespace gaussdrift::base {

/// Thrown at a seam where work is abandoned. It is no error, so what handles errors lets it pass.
struct Abandoned {};

/// Says whether work is to be abandoned. Several threads may ask at a time, thousands of times a second.
using AbandonWanted = std::function<bool()>;

namespace detail {

inline constinit thread_local const AbandonWanted* abandon_wanted = nullptr;

}  // namespace detail

/// While it lives, what this thread does, and what it shares with others by parallel_for(), is abandoned at the next seam
/// once `wanted` says so. Null: at none.
class Abandonable {
 public:
  explicit Abandonable(const AbandonWanted* wanted) : before_(detail::abandon_wanted) {
    detail::abandon_wanted = wanted;
  }
  ~Abandonable() { detail::abandon_wanted = before_; }
  Abandonable(const Abandonable&) = delete;
  Abandonable& operator=(const Abandonable&) = delete;

 private:
  const AbandonWanted* before_;
};

/// A place where work may be abandoned: then Abandoned is thrown. parallel_for() has one before each piece.
inline void seam() {
  if (detail::abandon_wanted && (*detail::abandon_wanted)()) throw Abandoned{};
}

}  // namespace gaussdrift::base
