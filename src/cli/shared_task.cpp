#include "cli/shared_task.hpp"

#include <string>

#include "base/broadcast.hpp"
#include "gaussdrift/read_case.hpp"

namespace gaussdrift::cli {

RunTask shared_task(base::Communicator& ranks, const std::function<RunTask()>& make) {
  const bool first = ranks.rank() == 0;
  RunTask task;
  ranks.agree_on([&] {
    if (first) task = make();
  });
  if (ranks.size() == 1) return task;
  std::string text = first && !task.done ? case_text(task.spec) : "", name = task.spec.name,
              folder = task.folder.string();
  int done = task.done ? static_cast<int>(*task.done) : -1;
  base::broadcast_values(ranks, [&](base::StateBytes& bytes) {
    bytes(text, name, folder, task.threads, task.stop_after, task.goes_on, done);
  });
  task.folder = folder;
  if (done >= 0) task.done = static_cast<ExitCode>(done);
  ranks.agree_on([&] {
    if (first || task.done) return;
    task.spec = parse_case(text, name + ".toml", {}, task.threads).spec;
    task.spec.name = name;
  });
  return task;
}

}  // namespace gaussdrift::cli
