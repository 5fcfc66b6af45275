#include "farfield/ranks/channel.hpp"

#include <exception>
#include <string>

namespace farfield::detail {
namespace {

enum class Kind : int { any, argument, tolerance, memory, time, range };

/// An error as bytes: its kind, its words, and what it keeps beside them.
Bytes told(const Error& error) {
  Kind kind = Kind::any;
  double number = 0;
  std::size_t whole = 0;
  std::string word;
  if (dynamic_cast<const InvalidArgument*>(&error)) kind = Kind::argument;
  if (dynamic_cast<const ToleranceError*>(&error)) kind = Kind::tolerance;
  if (const auto* memory = dynamic_cast<const MemoryLimitError*>(&error))
    kind = Kind::memory, number = memory->needed, whole = memory->limit;
  if (const auto* time = dynamic_cast<const TimeLimitError*>(&error))
    kind = Kind::time, number = time->seconds, whole = static_cast<std::size_t>(time->method);
  if (const auto* range = dynamic_cast<const RangeError*>(&error))
    kind = Kind::range, whole = range->target, word = range->quantity;
  Writer to;
  to.put(kind);
  to.put(number);
  to.put(whole);
  const std::string words = error.what();
  to.put_list(std::vector<char>(words.begin(), words.end()));
  to.put_list(std::vector<char>(word.begin(), word.end()));
  return to.take();
}

[[noreturn]] void throw_error(const Bytes& bytes) {
  Reader from(bytes);
  const auto kind = from.get<Kind>();
  const auto number = from.get<double>();
  const auto whole = from.get<std::size_t>();
  const auto text = [&] {
    const auto letters = from.get_list<char>();
    return std::string(letters.begin(), letters.end());
  };
  const std::string words = text(), word = text();
  switch (kind) {
    case Kind::argument:
      throw InvalidArgument(words);
    case Kind::tolerance:
      throw ToleranceError(words);
    case Kind::memory:
      throw MemoryLimitError(words, number, whole);
    case Kind::time:
      throw TimeLimitError(words, number, static_cast<Method>(whole));
    case Kind::range:
      throw RangeError(words, word, whole);
    default:
      throw Error(words);
  }
}

}  // namespace

std::vector<Bytes> Channel::exchange(std::vector<Bytes> out) const {
  std::vector<Bytes> in = ranks_.exchange(std::move(out));
  if (in.size() != size())
    throw Error("farfield: Ranks::exchange() returned bytes of " + std::to_string(in.size()) + " ranks, must be " +
                std::to_string(size()));
  return in;
}

std::vector<Bytes> Channel::exchange(std::vector<Bytes> out, double& received) const {
  std::vector<Bytes> in = exchange(std::move(out));
  for (std::size_t r = 0; r < in.size(); ++r) received += r == rank() ? 0.0 : static_cast<double>(in[r].size());
  return in;
}

void Channel::together(const std::function<void()>& work) const {
  std::exception_ptr trouble;
  Bytes words;
  try {
    work();
  } catch (const Error& error) {
    trouble = std::current_exception();
    words = told(error);
  }
  std::vector<double> first{trouble ? static_cast<double>(size() - rank()) : 0.0};  // largest for the lowest rank
  max(first);
  if (first[0] == 0) return;
  const std::size_t from = size() - static_cast<std::size_t>(first[0]);
  const std::vector<Bytes> in =
      exchange(from == rank() ? std::vector<Bytes>(size(), words) : std::vector<Bytes>(size()));
  if (from == rank()) std::rethrow_exception(trouble);
  throw_error(in[from]);
}

}  // namespace farfield::detail
