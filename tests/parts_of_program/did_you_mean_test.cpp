// SPDX-License-Identifier: BSL-1.0
// Each known name with one mistake is found again; what is far from all names is not forced onto one.
#include <boost/test/unit_test.hpp>

#include <string>
#include <vector>

#include "../../src/comparison/catalogue.hpp"
#include "../../src/comparison/did_you_mean.hpp"

using namespace nysalt::program;

namespace {

std::vector<std::string> all_names() {
  auto names = method_names();
  for (const auto& name : family_names()) names.push_back("learned:" + name);
  return names;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_name_with_one_mistake_is_found) {
  const auto names = all_names();
  for (const auto& name : names) {
    if (name.size() < 5) continue;  // one mistake in four letters may be another name
    std::string upper = name;
    for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    BOOST_TEST(nearest_name(upper, names) == name);
    for (std::size_t i = 1; i + 1 < name.size(); ++i) {
      std::string exchanged = name;
      std::swap(exchanged[i], exchanged[i + 1]);
      for (const std::string& typed :
           {name.substr(0, i) + name.substr(i + 1), name.substr(0, i) + "y" + name.substr(i), exchanged}) {
        const auto found = nearest_name(typed, names);
        BOOST_TEST(!found.empty(), typed);
      }
    }
  }
  BOOST_TEST(nearest_name("pefrll", names) == "pefrl");
  BOOST_TEST(nearest_name("mclachaln5", names) == "mclachlan5");
}

BOOST_AUTO_TEST_CASE(a_beginning_is_found) {
  const std::vector<std::string> systems{"fpu", "lennard_jones", "henon_heiles"};
  BOOST_TEST(nearest_name("lennard", systems) == "lennard_jones");
  BOOST_TEST(nearest_name("Henon", systems) == "henon_heiles");
  BOOST_TEST(nearest_name("le", systems) == "");
}

BOOST_AUTO_TEST_CASE(nothing_is_made_up) {
  const auto names = all_names();
  for (const char* typed : {"", "x", "zzzz", "nosuch", "gibberish_of_some_length"}) {
    BOOST_TEST(nearest_name(typed, names) == "", typed);
  }
  BOOST_TEST(nearest_name(std::string(100'000, 'v'), names) == "");
  BOOST_TEST(did_you_mean("nosuch", {"end", "symmetric", "middle"}) == "it is one of end, symmetric, middle");
  BOOST_TEST(did_you_mean("nosuch", names) == "nysalt list shows all");
  BOOST_TEST(did_you_mean("verlett", names) == "did you mean verlet?");
}
