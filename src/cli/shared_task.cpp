#include "cli/shared_task.hpp"

#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "base/state_bytes.hpp"
#include "gaussdrift/read_case.hpp"

namespace gaussdrift::cli {

RunTask shared_task(base::Communicator& ranks, const std::function<RunTask()>& make) {
  const bool first = ranks.rank() == 0;
  RunTask task;
  ranks.agree_on([&] {
    if (first) task = make();
  });
  if (ranks.size() == 1) return task;
  std::string text = first && !task.done ? case_text(task.spec) : "", name = task.spec.name;
  int done = task.done ? static_cast<int>(*task.done) : -1;
  base::StateBytes said;
  said(text, name, task.threads, task.stop_after, task.goes_on, done);
  base::Bytes bytes = base::to_bytes(std::span<const char>(said.written()));
  ranks.broadcast(bytes);
  const auto letters = base::from_bytes<char>(bytes);
  base::StateBytes heard(std::string_view(letters.data(), letters.size()));
  heard(text, name, task.threads, task.stop_after, task.goes_on, done);
  if (done >= 0) task.done = static_cast<ExitCode>(done);
  ranks.agree_on([&] {
    if (first || task.done) return;
    task.spec = parse_case(text, name + ".toml", {}, task.threads).spec;
    task.spec.name = name;
  });
  return task;
}

}  // namespace gaussdrift::cli
