// SPDX-License-Identifier: BSL-1.0
// Refusals must say why: an exception of the right type whose sentence has the words that help.
#pragma once

#include <boost/test/unit_test.hpp>

#include <initializer_list>
#include <stdexcept>
#include <string>
#include <string_view>

namespace nysalt::test {

/// Words of a refusal.
using said = std::initializer_list<std::string_view>;

template <class Exception = std::invalid_argument>
bool refuses(auto&& action, said words) {
  try {
    action();
  } catch (const Exception& e) {
    const std::string sentence = e.what();
    BOOST_TEST_CONTEXT("said: " << sentence) {
      for (const auto word : words) BOOST_TEST(sentence.find(word) != std::string::npos, "missing: " << word);
    }
    return true;
  }
  return false;
}

/// The sentence of a refusal; empty where nothing is refused.
template <class Exception = std::invalid_argument>
std::string refusal_of(auto&& action) {
  try {
    action();
  } catch (const Exception& e) {
    return e.what();
  }
  return "";
}

}  // namespace nysalt::test
