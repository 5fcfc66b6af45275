// In which order a run asks the disk for what: a name is given to what the disk has already, so that a loss of power
// leaves files that are whole or absent, and a checkpoint whose files are there.
#include <sstream>

#include "faults/suffering.hpp"

namespace gaussdrift {
namespace {

/// A call that the library has counted, in the order of the log.
struct Call {
  std::string name, inode, file;
};

class Order : public Faults {
 protected:
  std::vector<Call> calls_of(const std::string& command) {
    fs::remove(folder / "log.txt");
    const Outcome outcome = call(command, "FAULTS_LOG='" + (folder / "log.txt").string() + "'");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    std::vector<Call> calls;
    std::istringstream lines(read_file(folder / "log.txt"));
    for (Call one; lines >> one.name >> one.inode && std::getline(lines >> std::ws, one.file);) {
      // Open files have the names of the system, others those of the program.
      one.file = (fs::canonical(folder.path()) / one.file).lexically_normal().string();
      calls.push_back(one);
    }
    return calls;
  }
  std::string top() const { return (fs::canonical(folder.path()) / "part").string(); }
};

bool writes(const Call& call) { return call.name.ends_with("write") || call.name == "ftruncate"; }

/// Of a run that is moved aside or removed: its list goes last, once the disk knows that the other files are there or
/// gone. Without the list they would be nobody's.
class GoesLast {
 public:
  void see(const Call& call) {
    const fs::path file = call.file;
    const std::string parent = file.parent_path().string();
    if (call.name == "fsync") on_disk_[call.file] = true;
    if (call.inode == "0" || file.filename().string().starts_with(".")) return;
    if (call.name == "rename" && left_.contains(call.inode)) on_disk_[parent] = false;
    if (call.name != "leave" && call.name != "remove") return;
    if (file.filename() == "status.json") {
      ++lists_;
      for (const auto& [folder, yes] : on_disk_)
        if (fs::path(folder).string().starts_with(parent)) {
          EXPECT_TRUE(yes) << "the list in " << parent << " goes before the disk knows what became of " << folder;
        }
    }
    left_.insert(call.inode);
    on_disk_.erase(call.file);  // a folder that goes
    on_disk_[parent] = false;
  }
  int lists() const { return lists_; }

 private:
  std::map<std::string, bool> on_disk_;  // folders of which files were taken, or into which they were put
  std::set<std::string> left_;           // inodes of files that had another name
  int lists_ = 0;
};

/// `top`: the folder of the run. What is done to the folder around it is not counted.
void expect_order(const std::vector<Call>& calls, const std::string& top) {
  std::map<std::string, bool> file_is_on_disk;        // by inode
  std::map<std::string, bool> names_are_on_disk;      // by folder
  std::map<std::string, std::set<std::string>> made;  // by folder: folders in it that the disk may not have
  long renamed = 0, checkpoints = 0;
  for (const Call& call : calls) {
    const std::string parent = fs::path(call.file).parent_path().string();
    if (writes(call)) file_is_on_disk[call.inode] = false;
    if (call.name == "fsync") file_is_on_disk[call.inode] = names_are_on_disk[call.file] = true, made.erase(call.file);
    if (call.name == "mkdir" && call.file != top) made[parent].insert(call.file);
    if (call.name != "rename" || !file_is_on_disk.contains(call.inode)) continue;  // an earlier run that is moved aside
    ++renamed;
    EXPECT_TRUE(file_is_on_disk[call.inode]) << call.file << " gets its name before the disk has its bytes";
    if (call.file.ends_with("manifest.json")) {
      ++checkpoints;
      EXPECT_TRUE(names_are_on_disk[parent]) << "the disk may not have the names of a checkpoint's files in " << parent;
      EXPECT_TRUE(made.empty()) << "the disk may not have the folder " << *made.begin()->second.begin();
    }
    names_are_on_disk[parent] = false;
  }
  EXPECT_GT(renamed, 20);
  EXPECT_GT(checkpoints, 1);
  for (const auto& [folder, on_disk] : names_are_on_disk)
    if (fs::is_directory(folder)) {
      EXPECT_TRUE(on_disk) << "the disk may not have all names in " << folder;
    }
  for (const auto& [parent, folders] : made) ADD_FAILURE() << "the disk may not have the folder " << *folders.begin();
}

TEST_F(Order, OfANewRun) {
  write_file(folder / "small.toml", apart);
  expect_order(calls_of("run small.toml --out part"), top());
}

TEST_F(Order, OfARunInPlaceOfAnother) {
  write_file(folder / "small.toml", apart);
  ASSERT_EQ(call("run small.toml --out part").exit_code, 0);
  const std::vector<Call> calls = calls_of("run small.toml --out part --force");
  expect_order(calls, top());
  GoesLast order;
  for (const Call& one : calls) order.see(one);
  EXPECT_EQ(order.lists(), 2) << "one is moved aside, and removed there";
}

}  // namespace
}  // namespace gaussdrift
