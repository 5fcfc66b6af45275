// What rank 0 knows, for all ranks.
#pragma once

#include <string>

#include "base/communicator.hpp"
#include "base/state_bytes.hpp"

namespace gaussdrift::base {

/// Afterwards all ranks have the text of rank 0.
inline std::string broadcast_text(Communicator& ranks, const std::string& text) {
  if (ranks.size() == 1) return text;
  Bytes bytes = to_bytes(text);
  ranks.broadcast(bytes);
  return to_text(bytes);
}

/// The same of values: pass(bytes) hands each of them to the StateBytes.
template <class Pass>
void broadcast_values(Communicator& ranks, const Pass& pass) {
  if (ranks.size() == 1) return;
  StateBytes said;
  pass(said);
  const std::string told = broadcast_text(ranks, said.written());
  StateBytes heard(told);
  pass(heard);
}

}  // namespace gaussdrift::base
