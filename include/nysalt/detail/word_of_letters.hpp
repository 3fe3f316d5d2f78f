// SPDX-License-Identifier: BSL-1.0
// From letters as text to a word as a type.
#pragma once

#include <cstddef>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

#include "nysalt/run_time_word.hpp"

namespace nysalt::detail {

template <char Letter, class Flows>
struct flow_with_letter;
template <char Letter, class First, class... Rest>
struct flow_with_letter<Letter, std::tuple<First, Rest...>>
    : std::conditional_t<First::letter == Letter, std::type_identity<First>,
                         flow_with_letter<Letter, std::tuple<Rest...>>> {};

template <class Text, std::size_t... I>
auto spelled(std::index_sequence<I...>)
    -> word<typename flow_with_letter<Text::letters()[I], known_letters>::type...>;

/// The word of known letters that Text::letters(), a std::string_view, spells.
template <class Text>
using word_of_letters = decltype(spelled<Text>(std::make_index_sequence<Text::letters().size()>{}));

}  // namespace nysalt::detail
