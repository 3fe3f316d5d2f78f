// SPDX-License-Identifier: BSL-1.0
// Programs of others, compiled by what the .pc files say, against the headers and the library of this build.
// Installed, by CMake and by other ways: tests/long/consumer.
#include <boost/test/unit_test.hpp>

#include <filesystem>
#include <string>

#include "../support/program.hpp"

using namespace nysalt::test;

BOOST_AUTO_TEST_CASE(programs_compile_and_link_by_pkg_config) {
  const scratch folder("smoke_consumer");
  if (shell(folder, "pkg-config --version").code != 0) return;
  const auto built = std::filesystem::path(NYSALT_PROGRAM).parent_path();
  std::filesystem::create_symlink(built / "libnysalt.a", folder / "libnysalt.a");
  // The compiler of the library, and options that it must share with all that it is linked to.
  const std::string compile = "PKG_CONFIG_PATH='" + built.string() +
                              "'\":$PKG_CONFIG_PATH\"; export PKG_CONFIG_PATH\nflags='" +
                              (built / "plugin.flags").string() +
                              "'\n$(head -n 1 \"$flags\") -std=c++20 $(grep -E "
                              "'^(-fsanitize|-fprofile|-fcoverage|--coverage)' \"$flags\") ";
  for (const auto& [name, package] :
       {std::pair{"core", "nysalt"}, {"learn", "nysalt-learn"}, {"integrate", "nysalt"}}) {
    const std::string source = NYSALT_SOURCE_DIR "/tests/long/consumer/" + std::string(name) + "/main.cpp";
    const auto compiled =
        shell(folder, compile + "'" + source +
                          "' -o program $(pkg-config --static --define-variable=libdir=$PWD "
                          "--define-variable=includedir='" NYSALT_SOURCE_DIR "/include' --cflags --libs " +
                          package + ")");
    BOOST_TEST_REQUIRE(compiled.code == 0, name << ": " << compiled.err);
    const auto told = shell(folder, "cmake -D PROGRAM=$PWD/program -D SOURCE='" + source +
                                        "' -P '" NYSALT_SOURCE_DIR "/tests/check_example.cmake'");
    BOOST_TEST(told.code == 0, name << ": " << told.err);
  }
}
