#include "base/json_file.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "gaussdrift/error.hpp"
#include "message_of.hpp"
#include "scratch_folder.hpp"

namespace gaussdrift::base {
namespace {

namespace fs = std::filesystem;

class JsonFile : public testing::Test {
 protected:
  std::string refusal(const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
    return refusal();
  }
  std::string refusal() {
    return message_of<FileError>([&] { json_if_there(file, 100'000, "remove it"); });
  }
  static std::string nested(std::size_t deep) {
    return R"({"a":)" + std::string(deep - 1, '[') + std::string(deep - 1, ']') + "}";
  }
  const ScratchFolder folder;
  const fs::path file = folder / "a.json";
};

TEST_F(JsonFile, ThatIsNotThereIsNone) { EXPECT_FALSE(json_if_there(file, 100, "")); }

TEST_F(JsonFile, KeepsTheOrderOfItsMembers) {
  std::ofstream(file) << R"({"b": [1, {"c": "\u00e9"}], "a": null})";
  EXPECT_EQ(json_if_there(file, 100, "").value().dump(), "{\"b\":[1,{\"c\":\"\xc3\xa9\"}],\"a\":null}");
}

TEST_F(JsonFile, IsReadUpToItsBounds) {
  std::string many = "{";
  for (int i = 0; i < 1000; ++i) many += (i ? ",\"" : "\"") + std::to_string(i) + "\":{}";
  for (const std::string& text : {nested(50), many + "}", "{\"a\":[" + std::string(90'000, ' ') + "]}"}) {
    std::ofstream(file) << text;
    EXPECT_TRUE(json_if_there(file, 100'000, "")) << text.substr(0, 60);
  }
  EXPECT_NE(refusal(nested(51)).find("a.json is damaged: it is nested more than 50 deep; remove it"),
            std::string::npos);
  EXPECT_NE(refusal(many + ",\"more\":0}").find("an object in it has more than 1000 members"), std::string::npos);
  EXPECT_NE(refusal(std::string(100'001, ' ')).find("it has 100001 bytes, at most 100000 are read"), std::string::npos);
}

// What is deep is refused where it is deep: what follows is not looked at, and no function calls itself.
TEST_F(JsonFile, ThatIsNestedWithoutEndIsNoCrash) {
  for (const char* brackets : {"[", "{\"a\":"}) {
    std::string text = R"({"a":)";
    for (int i = 0; i < 15'000; ++i) text += brackets;
    EXPECT_NE(refusal(text).find("nested more than 50 deep"), std::string::npos) << brackets;
  }
}

TEST_F(JsonFile, ThatIsNoneIsRefusedWithThePlace) {
  EXPECT_NE(refusal("{\"a\": 1,\n \"b\" 2}").find("line 2, column 6: this is no JSON"), std::string::npos) << refusal();
  EXPECT_NE(refusal("").find("line 1, column 1: this is no JSON"), std::string::npos) << refusal();
  EXPECT_NE(refusal("{\"a\": 1e999}").find("line 1, column 11: a number is too large"), std::string::npos) << refusal();
  for (const char* text : {"[]", "3", "\"{}\"", "null", "true"})
    EXPECT_NE(refusal(text).find("it is no JSON object"), std::string::npos) << text;
  for (const char* text : {"{} {}", "{", "{\"a\"", "\xff", "{\"\xff\": 1}"})
    EXPECT_NE(refusal(text).find("this is no JSON"), std::string::npos) << text;
}

TEST_F(JsonFile, ThatIsALinkOrAFolderIsRefused) {
  std::ofstream(folder / "b.json") << "{}";
  fs::create_symlink(folder / "b.json", file);
  EXPECT_NE(refusal().find("it is a link, and links are not followed"), std::string::npos);
  fs::remove(file);
  fs::create_symlink(folder / "nowhere", file);
  EXPECT_NE(refusal().find("it is a link, and links are not followed"), std::string::npos);
  fs::remove(file);
  fs::create_directory(file);
  EXPECT_NE(refusal().find("it is no regular file"), std::string::npos);
}

}  // namespace
}  // namespace gaussdrift::base
