// Who may write into the folder of a run, and what becomes of an earlier one.
#include "write/run_folder.hpp"
#include "parsed_json.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "gaussdrift/error.hpp"
#include "message_of.hpp"
#include "scratch_folder.hpp"
#include "write/atomic_file.hpp"
#include "write/disk.hpp"
#include "write/output_files.hpp"

namespace gaussdrift::write {
namespace {

namespace fs = std::filesystem;

Case some_case(std::size_t outputs = 3) {
  Case spec;
  spec.name = "some";
  spec.output.files = {density_output().about};
  for (std::size_t i = 0; i < outputs; ++i) spec.output.times.push_back(static_cast<double>(i));
  return spec;
}

std::string state_in(const fs::path& folder) {
  return parsed_json(read_file(folder / "status.json")).at("state").get<std::string>();
}

/// A run that writes some of its files and is complete, or not.
void run_in(const fs::path& folder, const std::string& mark, bool force, int outputs, bool completes) {
  const Case spec = some_case();
  RunFolder run(folder, spec, {.force = force});
  write_run_inputs(folder, spec, mark);
  const auto watch = run.watch();
  for (int i = 0; i < outputs; ++i) {
    std::string name = "density/density_0000.vti";
    name[name.size() - 5] = static_cast<char>('0' + i);
    write_text(folder / name, mark);
    write_text(folder / "density.pvd", mark);
    write_text(folder / "state/0/manifest.json", mark);
    watch->frame(Frame{.index = i, .time = i * 1., .numbers = {}});
  }
  if (completes) run.complete();
}

TEST(RunFolder, TellsHowFarTheRunIs) {
  const ScratchFolder folder;
  {
    RunFolder run(folder / "r", some_case(), {});
    EXPECT_EQ(state_in(folder / "r"), "running");
    run.watch()->frame(Frame{.index = 0, .time = 0.5, .numbers = {}});
    const auto status = parsed_json(read_file(folder / "r/status.json"));
    EXPECT_EQ(status.at("outputs"), 1);
    EXPECT_EQ(status.at("last_output"), 0.5);
    EXPECT_EQ(status.at("pid"), getpid());
  }
  EXPECT_EQ(state_in(folder / "r"), "failed");
  run_in(folder / "r", "a", true, 1, true);
  EXPECT_EQ(state_in(folder / "r"), "complete");
  EXPECT_FALSE(fs::exists(folder / "r" / lock_name));
}

TEST(RunFolder, IsOfOneProcessAtATime) {
  const ScratchFolder folder;
  const RunFolder run(folder / "r", some_case(), {});
  const std::string before = read_file(folder / "r/status.json");
  for (const bool force : {false, true}) {
    const auto text = message_of<FileError>([&] { RunFolder(folder / "r", some_case(), {.force = force}); });
    EXPECT_NE(text.find("is in use: process " + std::to_string(getpid()) + " on "), std::string::npos) << text;
  }
  EXPECT_NE(message_of<FileError>([&] { FolderLock(folder / "r"); }), "");
  EXPECT_EQ(read_file(folder / "r/status.json"), before);
}

TEST(FolderLock, ClearsWhatKilledProcessesLeftInAllFoldersOfARun) {
  const ScratchFolder folder;
  for (const char* name : {".gaussdrift-7-1.part", "density/.gaussdrift-7-2.part", "state/1/.gaussdrift-7-3.part"})
    write_text(folder / name, "half");
  write_text(folder / "state/1/manifest.json", "whole");
  const FolderLock lock(folder.path());
  for (const char* name : {".gaussdrift-7-1.part", "density/.gaussdrift-7-2.part", "state/1/.gaussdrift-7-3.part"})
    EXPECT_FALSE(std::filesystem::exists(folder / name)) << name;
  EXPECT_TRUE(std::filesystem::exists(folder / "state/1/manifest.json"));
}

TEST(RunFolder, KeepsTheEarlierRunUntilTheNewOneHasAnOutput) {
  const ScratchFolder folder;
  run_in(folder / "r", "old", false, 3, true);
  write_text(folder / "r/notes.txt", "mine");
  write_text(folder / "r/density/mine_0001.vti", "mine");
  {
    RunFolder run(folder / "r", some_case(), {.force = true});
    EXPECT_TRUE(run.keeps_earlier());
    EXPECT_EQ(read_file(folder / "r/earlier/density/density_0002.vti"), "old");
    EXPECT_EQ(read_file(folder / "r/earlier/state/0/manifest.json"), "old");
    EXPECT_EQ(state_in(folder / "r/earlier"), "complete");
    EXPECT_FALSE(fs::exists(folder / "r/run.toml"));
  }  // fails before its first output
  EXPECT_TRUE(fs::exists(folder / "r/earlier/run.toml"));
  EXPECT_NE(message_of<FileError>([&] { run_in(folder / "r", "new", false, 1, true); }), "") << "without --force";
  run_in(folder / "r", "failed again", true, 0, false);
  EXPECT_EQ(read_file(folder / "r/earlier/density/density_0002.vti"), "old");
  run_in(folder / "r", "new", true, 1, true);
  EXPECT_FALSE(fs::exists(folder / "r/earlier"));
  EXPECT_FALSE(fs::exists(folder / "r/density/density_0002.vti"));
  EXPECT_EQ(read_file(folder / "r/density/density_0000.vti"), "new");
  EXPECT_EQ(read_file(folder / "r/notes.txt"), "mine");
  EXPECT_EQ(read_file(folder / "r/density/mine_0001.vti"), "mine");
}

/// As if the process had been killed between two of the files that it moves.
TEST(RunFolder, IsUsableAfterAProcessThatWasKilledWhileItMovedTheEarlierRun) {
  const ScratchFolder folder;
  for (const int moved : {0, 1, 4, 6}) {
    const fs::path r = folder / std::to_string(moved);
    run_in(r, "old", false, 3, true);
    auto status = parsed_json(read_file(r / "status.json"));
    status["set_aside"] = true;
    write_text(r / "status.json", status.dump());
    fs::create_directories(r / "earlier/density");
    int left = moved;
    for (const char* file : {"density/density_0000.vti", "density/density_0001.vti", "density/density_0002.vti",
                             "density.pvd", "run.toml", "view.py"})
      if (left-- > 0) fs::rename(r / file, r / "earlier" / file);
    {
      const RunFolder run(r, some_case(), {.force = true});
      EXPECT_TRUE(run.keeps_earlier());
      for (const char* file : {"density/density_0000.vti", "density/density_0002.vti", "density.pvd", "run.toml"})
        EXPECT_EQ(read_file(r / "earlier" / file), "old") << file << moved;
    }
    run_in(r, "new", true, 2, true);
    EXPECT_FALSE(fs::exists(r / "earlier")) << moved;
    EXPECT_EQ(read_file(r / "density/density_0001.vti"), "new");
  }
}

TEST(RunFolder, IsUsableAfterAProcessThatWasKilledAtOnce) {
  const ScratchFolder folder;
  fs::create_directories(folder / "locked");
  write_text(folder / ("locked/" + std::string(lock_name)), "process 1 on nowhere\n");
  write_file(folder / "locked/.gaussdrift-1-2.part", "half");
  run_in(folder / "locked", "a", false, 1, true);
  EXPECT_FALSE(fs::exists(folder / "locked/.gaussdrift-1-2.part"));

  fs::create_directories(folder / "old_version");
  write_file(folder / "old_version/run.toml.part", "half");
  run_in(folder / "old_version", "a", true, 1, true);
  EXPECT_FALSE(fs::exists(folder / "old_version/run.toml.part"));

  run_in(folder / "no_output", "a", false, 0, false);
  run_in(folder / "no_output", "b", false, 1, true);  // nothing is lost
  EXPECT_NE(message_of<FileError>([&] { run_in(folder / "no_output", "c", false, 1, true); }), "");
}

TEST(RunFolder, IsUsableAfterAProcessThatWasKilledWhenTheEarlierRunWasGoneAndItsFolderWasNot) {
  const ScratchFolder folder;
  run_in(folder / "r", "old", false, 1, false);
  fs::create_directory(folder / "r/earlier");
  run_in(folder / "r", "new", true, 1, true);
  EXPECT_EQ(state_in(folder / "r"), "complete");
  EXPECT_FALSE(fs::exists(folder / "r/earlier"));
}

TEST(RunFolder, ReplacesARunOfAVersionWithoutAList) {
  const ScratchFolder folder;
  for (const char* file : {"run.toml", "density.pvd", "density/density_0007.vti", "images/surface_0007.png"})
    write_text(folder / "r" / file, "old");
  write_text(folder / "r/images/photo_0007.png", "mine");
  {
    RunFolder run(folder / "r", some_case(), {.force = true, .picture_styles = {"surface"}});
    EXPECT_EQ(read_file(folder / "r/earlier/images/surface_0007.png"), "old");
    run.watch()->frame(Frame{.index = 0, .numbers = {}});
    run.complete();
  }
  EXPECT_FALSE(fs::exists(folder / "r/earlier"));
  EXPECT_FALSE(fs::exists(folder / "r/density"));
  EXPECT_EQ(read_file(folder / "r/images/photo_0007.png"), "mine");
}

TEST(RunFolder, FollowsNoLinks) {
  const ScratchFolder folder;
  write_text(folder / "precious/density_0000.vti", "mine");
  run_in(folder / "r", "old", false, 1, true);
  fs::remove_all(folder / "r/density");
  fs::create_directory_symlink(folder / "precious", folder / "r/density");
  const auto text = message_of<FileError>([&] { run_in(folder / "r", "new", true, 1, true); });
  EXPECT_NE(text.find("density in it is a link, and links are not followed"), std::string::npos) << text;
  EXPECT_EQ(read_file(folder / "precious/density_0000.vti"), "mine");
  EXPECT_EQ(state_in(folder / "r"), "complete");
}

TEST(RunFolder, LeavesWhatOthersHavePutBesideItsCheckpoints) {
  const ScratchFolder folder;
  run_in(folder / "r", "old", false, 1, true);
  write_text(folder / "r/state/1/run.raw", "its own");
  write_text(folder / "r/state/notes.txt", "mine");
  write_text(folder / "r/state/1/particles_0001.raw", "its own");
  write_text(folder / "r/state/pictures/density_0001.raw", "its own");
  const char* of_others[] = {"state/9/x", "state/0/notes.txt", "state/1/particles_1.raw", "state/pictures/mine.png",
                             "state/0/run.raw/x"};
  for (const char* name : of_others) write_text(folder / "r" / name, "mine");
  run_in(folder / "r", "new", true, 1, true);
  for (const char* name : {"run.raw", "particles_0001.raw"}) EXPECT_FALSE(fs::exists(folder / "r/state/1" / name));
  EXPECT_FALSE(fs::exists(folder / "r/state/pictures/density_0001.raw"));
  EXPECT_EQ(read_file(folder / "r/state/notes.txt"), "mine");
  for (const char* name : of_others) EXPECT_EQ(read_file(folder / "r" / name), "mine") << name;
}

/// Earlier versions put whole folders on the list.
TEST(RunFolder, LeavesWhatOthersHavePutBesideTheCheckpointsOfAnEarlierVersion) {
  for (const std::vector<std::string>& state :
       {std::vector<std::string>{"state/"}, {"state/0/", "state/1/", "state/pictures/", "state/outputs.raw"}}) {
    const ScratchFolder folder;
    run_in(folder / "r", "old", false, 1, true);
    auto status = parsed_json(read_file(folder / "r/status.json"));
    std::vector<std::string> names;
    for (const std::string name : status["files"])
      if (!name.starts_with("state/")) names.push_back(name);
    names.insert(names.end(), state.begin(), state.end());
    status["files"] = names;
    write_text(folder / "r/status.json", status.dump());
    for (const char* name : {"state/0/notes.txt", "state/pictures/mine.png"}) write_text(folder / "r" / name, "mine");
    for (const char* name : {"state/1/manifest.json", "state/pictures/error_0003.raw", "state/outputs.raw"})
      write_text(folder / "r" / name, "its own");
    run_in(folder / "r", "new", true, 1, true);
    for (const char* name : {"state/1/manifest.json", "state/pictures/error_0003.raw", "state/outputs.raw"})
      EXPECT_FALSE(fs::exists(folder / "r" / name)) << name;
    for (const char* name : {"state/0/notes.txt", "state/pictures/mine.png"})
      EXPECT_EQ(read_file(folder / "r" / name), "mine") << name;
  }
}

/// A process may be killed between the files of a folder and the folder.
TEST(OwnFiles, TakesFoldersThatAreLeftEmpty) {
  const ScratchFolder folder;
  for (const char* name : {"density/density_0001", "state/0", "images/mine"})
    fs::create_directories(folder / "r" / name);
  fs::create_directories(folder / "r/others");
  OwnFiles({numbered_names(numbered_names("density/density_", 3, "/"), 2, ".vti"), "state/0/", "images/a.png"})
      .remove_from(folder / "r");
  for (const char* name : {"density", "state"}) EXPECT_FALSE(fs::exists(folder / "r" / name)) << name;
  for (const char* name : {"images/mine", "others"}) EXPECT_TRUE(fs::exists(folder / "r" / name)) << name;
}

TEST(RunFolder, FollowsNoLinksFurtherInside) {
  for (const char* place : {"state/0", "state/1", "state/pictures", "density/density_0000", "earlier/density",
                            "earlier/state", "earlier/state/0"}) {
    const ScratchFolder folder;
    write_text(folder / "precious/density_0000.vti", "mine");
    run_in(folder / "r", "old", false, 1, true);
    fs::create_directories((folder / "r" / place).parent_path());
    fs::remove_all(folder / "r" / place);
    fs::create_directory_symlink(folder / "precious", folder / "r" / place);
    for (const RunFolderOptions& options : {RunFolderOptions{.force = true}, RunFolderOptions{.go_on = true}}) {
      const auto text = message_of<FileError>([&] { RunFolder(folder / "r", some_case(1), options); });
      EXPECT_NE(text.find(std::string(place) + " in it is a link, and links are not followed"), std::string::npos)
          << place << ": " << text;
    }
    EXPECT_EQ(read_file(folder / "precious/density_0000.vti"), "mine");
    EXPECT_EQ(state_in(folder / "r"), "complete");
  }
}

TEST(RunFolder, ReplacesNoFileThatIsNotOnTheListOfTheEarlierRun) {
  const ScratchFolder folder;
  run_in(folder / "r", "old", false, 1, true);
  write_text(folder / "r/density/density_0007.vti", "mine");  // a run of 3 outputs does not write it
  const Case longer = some_case(9);
  const auto text = message_of<FileError>([&] { RunFolder(folder / "r", longer, {.force = true}); });
  EXPECT_NE(text.find("density/density_0007.vti in it is no file of the earlier run"), std::string::npos) << text;
  EXPECT_EQ(read_file(folder / "r/density/density_0000.vti"), "old");
}

TEST(RunFolder, TakesNoListThatLeadsOutOfIt) {
  const ScratchFolder folder;
  write_text(folder / "precious", "mine");
  write_text(
      folder / "r/status.json",
      R"({"kind": "run", "outputs": 1, "last_output": 0, "files": ["../precious", "/etc/passwd", "a/../../precious"]})");
  run_in(folder / "r", "new", true, 1, true);
  EXPECT_EQ(read_file(folder / "precious"), "mine");
  for (const char* foreign : {"{}", R"({"kind": 1})"}) {
    write_text(folder / "s/status.json", foreign);
    const auto text = message_of<FileError>([&] { run_in(folder / "s", "new", true, 1, true); });
    EXPECT_NE(text.find("holds no earlier run"), std::string::npos) << text;
  }
}

TEST(RunFolder, RefusesAListThatIsDamagedWithTheReason) {
  const ScratchFolder folder;
  std::string many = R"({"kind": "run", "outputs": 1, "last_output": 0, "files": [")";
  for (int i = 0; i < 40'000; ++i) many += "a\",\"";
  const std::string rest = R"(, "last_output": 0, "files": []})";
  for (const auto& [damaged, why] : {std::pair<std::string, const char*>{"[", "it is no JSON object"},
                                     {R"({"kind": "run", "files": 3})", "a member is missing or has another type"},
                                     {R"({"kind": "run", "outputs": -1)" + rest, "outputs is no count"},
                                     {R"({"kind": "run", "outputs": 1e300)" + rest, "outputs is no count"},
                                     {many + "b\"]}", "it lists more than 40000 files"}}) {
    write_text(folder / "s/status.json", damaged);
    const auto text = message_of<FileError>([&] { run_in(folder / "s", "new", true, 1, true); });
    EXPECT_NE(text.find("s/status.json is damaged: " + std::string(why)), std::string::npos) << text;
    EXPECT_EQ(read_file(folder / "s/status.json"), damaged);
  }
}

TEST(RunFolder, RefusesARunThatTheDiskCannotTakeWithBothNumbers) {
  const ScratchFolder folder;
  const auto text = message_of<FileError>([&] { RunFolder(folder / "new/r", some_case(), {.bytes = 1e18}); });
  EXPECT_NE(text.find("will write about 1e+12 MB, and "), std::string::npos) << text;
  EXPECT_FALSE(fs::exists(folder / "new"));
}

/// Pieces are the run's own by their names, and what others put beside them is not.
TEST(RunFolder, LeavesWhatOthersHavePutBesideItsPieces) {
  const ScratchFolder folder;
  Case spec = some_case();
  for (const FileKind& kind : output_files())
    if (kind.particle_piece) spec.output.files.push_back(kind.about);
  {
    RunFolder run(folder / "r", spec, {.particle_pieces = 2});
    for (const char* file : {"particles/particles_0000/0000.vtp", "particles/particles_0000/0001.vtp",
                             "particles/particles_0000.pvtp", "density/density_0000.vti"})
      write_text(folder / "r" / file, "its own");
    run.watch()->frame(Frame{.index = 0, .time = 0, .numbers = {}});
    run.complete();
  }
  const std::vector<std::string> of_others{"particles/particles_0000/notes.txt", "particles/particles_0000/0002.vtp",
                                           "particles/particles_0002/notes.txt", "density/density_0001/0000.vti",
                                           "density/density_0001/x/y.txt"};
  for (const std::string& file : of_others) write_text(folder / "r" / file, "mine");
  {
    const RunFolder run(folder / "r", spec, {.force = true});
    EXPECT_EQ(read_file(folder / "r/earlier/particles/particles_0000/0001.vtp"), "its own");
    EXPECT_EQ(read_file(folder / "r/earlier/particles/particles_0000.pvtp"), "its own");
  }
  {
    RunFolder run(folder / "r", spec, {.force = true});
    run.watch()->frame(Frame{.index = 0, .time = 0, .numbers = {}});
    run.complete();
  }
  EXPECT_FALSE(fs::exists(folder / "r/earlier"));
  EXPECT_FALSE(fs::exists(folder / "r/particles/particles_0000/0000.vtp"));
  for (const std::string& file : of_others) EXPECT_EQ(read_file(folder / "r" / file), "mine") << file;
}

TEST(RunFolder, SaysThatItFailedOnADiskThatIsFull) {
  const ScratchFolder folder;
  const SmallDisk disk(folder.path());
  if (!disk.mounted()) GTEST_SKIP() << "this user may not mount a small file system";
  {
    RunFolder run(folder / "r", some_case(), {});
    std::string fill(1 << 20, 'x');
    while (!fill.empty()) {
      try {
        write_text(folder / ("fill" + std::to_string(fill.size())), fill);
        fill.resize(fill.size() / 2 + 1 == fill.size() ? 0 : fill.size() / 2);
      } catch (const FileError&) {
        fill.resize(fill.size() / 2);
      }
    }
    EXPECT_EQ(state_in(folder / "r"), "running");
    EXPECT_THROW(write_text(folder / "more", "x"), FileError) << "the disk is full";
  }
  EXPECT_EQ(state_in(folder / "r"), "failed");
  EXPECT_TRUE(is_in_use(folder / "r") == false);
  for (const auto& entry : fs::directory_iterator(folder / "r")) EXPECT_EQ(entry.path().filename(), "status.json");
}

TEST(FolderLock, IsSeenByOthers) {
  const ScratchFolder folder;
  EXPECT_FALSE(is_in_use(folder.path()));
  {
    const FolderLock lock(folder.path());
    EXPECT_TRUE(is_in_use(folder.path()));
  }
  write_text(folder / lock_name, "process 1 on nowhere\n");  // left by a process that was killed
  EXPECT_FALSE(is_in_use(folder.path()));
}

TEST(OwnFiles, HasRangesAndFolders) {
  const OwnFiles files({"a.csv", numbered_names("d/d_", 12, ".vti"), "state/", "others/"});
  for (const char* name : {"a.csv", "d/d_0000.vti", "d/d_0011.vti", "state/0/run.raw", "state/1/particles_0003.raw"})
    EXPECT_TRUE(files.has(name)) << name;
  for (const char* name : {"b.csv", "d/d_0012.vti", "d/d_11.vti", "d/d_00011.vti", "d/d_.vti", "d_0001.vti", "state",
                           "state/x", "state/0/x", "state/2/run.raw", "others/x", "d/d_{0000..0011}.vtix"})
    EXPECT_FALSE(files.has(name)) << name;
  EXPECT_TRUE(OwnFiles({numbered_names("d_", 20000, "")}).has("d_12345"));
  const OwnFiles pieces({numbered_names(numbered_names("d/d_", 12, "/"), 3, ".vti")});
  for (const char* name : {"d/d_0000/0000.vti", "d/d_0011/0002.vti"}) EXPECT_TRUE(pieces.has(name)) << name;
  for (const char* name :
       {"d/d_0012/0000.vti", "d/d_0011/0003.vti", "d/d_0011/0002.vtp", "d/d_0011", "d/d_0011/", "d/0002.vti"})
    EXPECT_FALSE(pieces.has(name)) << name;
  const OwnFiles of_earlier_version({"d/d_{0000..0011}/"});
  EXPECT_TRUE(of_earlier_version.has("d/d_0003/0123.vti"));
  EXPECT_FALSE(of_earlier_version.has("d/d_0003/notes.txt"));
}

}  // namespace
}  // namespace gaussdrift::write
