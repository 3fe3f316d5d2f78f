// SPDX-License-Identifier: BSL-1.0
// A point in phase space, and many of them in two matrices.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <iterator>
#include <type_traits>
#include <utility>
#include <vector>

#include "nysalt/scalar.hpp"

// A point of phase space.

namespace nysalt {

/// A column of N scalars, N fixed or Eigen::Dynamic.
template <class T, int N>
using vector = Eigen::Matrix<T, N, 1>;

/// Positions q and momenta p of one state, each of the system's dimension.
template <Scalar T, int N>
struct phase_point {
  using scalar_type = T;               ///< type of each entry
  static constexpr int dimension = N;  ///< N, fixed or Eigen::Dynamic

  vector<T, N> q;  ///< positions, one for each degree of freedom
  vector<T, N> p;  ///< momenta (not velocities), likewise

  Eigen::Index size() const { return q.size(); }  ///< degrees of freedom

  /// The state in another scalar type, as constants.
  template <Scalar U>
  phase_point<U, N> cast() const {
    phase_point<U, N> result{vector<U, N>(size()), vector<U, N>(size())};
    for (Eigen::Index i = 0; i < size(); ++i) {
      result.q[i] = U(q[i]);
      result.p[i] = U(p[i]);
    }
    return result;
  }
};

/// No NaN and no infinity in q and p.
template <int N>
bool is_finite(const phase_point<double, N>& x) {
  return x.q.allFinite() && x.p.allFinite();
}

// Many vectors, or points of phase space, of one dimension that is known at run time.

namespace detail {

/// An iterator over a list whose items are made when they are read.
template <class List>
class list_iterator {
 public:
  using difference_type = std::ptrdiff_t;
  using value_type = decltype(std::declval<List&>()[0]);

  list_iterator() = default;
  list_iterator(List* list, std::size_t at) : list_(list), at_(at) {}
  value_type operator*() const { return (*list_)[at_]; }
  list_iterator& operator++() {
    ++at_;
    return *this;
  }
  list_iterator operator++(int) {
    list_iterator before = *this;
    ++at_;
    return before;
  }
  friend bool operator==(const list_iterator&, const list_iterator&) = default;

 private:
  List* list_ = nullptr;
  std::size_t at_ = 0;
};

/// Vectors of one dimension, one after the other in memory. An item is an Eigen::Map.
class vector_list {
 public:
  vector_list() = default;
  /// n vectors, their entries not set.
  vector_list(std::size_t count, Eigen::Index dimension) { resize(count, dimension); }

  std::size_t size() const { return size_; }             ///< number of vectors
  Eigen::Index dimension() const { return dimension_; }  ///< length of each vector; 0 while there is none
  void resize(std::size_t count,
              Eigen::Index dimension) {  ///< vectors that are there stay if the dimension does
    dimension_ = dimension;
    size_ = count;
    numbers_.resize(count * static_cast<std::size_t>(dimension));
  }
  void clear() { resize(0, dimension_); }  ///< the dimension stays
  /// Vector i, which may be changed.
  Eigen::Map<Eigen::VectorXd> operator[](std::size_t i) { return {numbers_.data() + offset(i), dimension_}; }
  /// Vector i.
  Eigen::Map<const Eigen::VectorXd> operator[](std::size_t i) const {
    return {numbers_.data() + offset(i), dimension_};
  }
  /// Behind those that there are, of their dimension; x may be one of them.
  void push_back(const auto& x) {
    const Eigen::VectorXd copy = x;  // NOLINT(performance-unnecessary-copy-initialization)
    resize(size_ + 1, copy.size());
    (*this)[size_ - 1] = copy;
  }
  /// Appends the vectors of another list.
  void append(const vector_list& more) {
    const std::size_t further = more.size_;
    const std::size_t count = more.numbers_.size();
    if (further == 0) return;
    resize(size_ + further, more.dimension_);
    std::copy_n(more.numbers_.begin(), count, numbers_.end() - static_cast<std::ptrdiff_t>(count));
  }
  auto begin() { return detail::list_iterator(this, 0); }          ///< begin iterator
  auto end() { return detail::list_iterator(this, size_); }        ///< end iterator
  auto begin() const { return detail::list_iterator(this, 0); }    ///< begin iterator
  auto end() const { return detail::list_iterator(this, size_); }  ///< end iterator
  /// Equal numbers.
  friend bool operator==(const vector_list& a, const vector_list& b) {
    return a.size_ == b.size_ && a.numbers_ == b.numbers_;
  }

 private:
  std::size_t offset(std::size_t i) const { return i * static_cast<std::size_t>(dimension_); }

  std::vector<double> numbers_;
  std::size_t size_ = 0;
  Eigen::Index dimension_ = 0;
};

/// A point of phase space in a list. Column is an Eigen::Map.
template <class Column>
struct listed_point {
  using scalar_type = double;                       ///< type of each entry
  static constexpr int dimension = Eigen::Dynamic;  ///< known at run time

  Column q;  ///< positions
  Column p;  ///< momenta

  Eigen::Index size() const { return q.size(); }  ///< degrees of freedom
  /// A copy; N is the dimension, or Eigen::Dynamic.
  template <int N>
  operator phase_point<double, N>() const {  // NOLINT(google-explicit-constructor)
    return {q, p};
  }
  /// The state in another scalar type, as constants.
  template <Scalar T>
  phase_point<T, Eigen::Dynamic> cast() const {
    return phase_point<double, Eigen::Dynamic>{q, p}.template cast<T>();
  }
};

}  // namespace detail

/// No NaN and no infinity in q and p.
template <class Column>
bool is_finite(const detail::listed_point<Column>& x) {
  return x.q.allFinite() && x.p.allFinite();
}

/// Points of phase space of one dimension, one after the other in memory: q of one, then p.
class phase_points {
 public:
  phase_points() = default;
  /// n points, their entries not set.
  phase_points(std::size_t count, Eigen::Index dimension) { resize(count, dimension); }
  /// Copies of these.
  template <int N>
  phase_points(const std::vector<phase_point<double, N>>& points) {  // NOLINT(google-explicit-constructor)
    for (const auto& x : points) push_back(x);
  }

  std::size_t size() const { return columns_.size() / 2; }         ///< number of points
  bool empty() const { return size() == 0; }                       ///< whether there is none
  Eigen::Index dimension() const { return columns_.dimension(); }  ///< degrees of freedom; 0 before a point
  /// Points that are there stay if the dimension does.
  void resize(std::size_t count, Eigen::Index dimension) { columns_.resize(2 * count, dimension); }
  void resize(std::size_t count) {
    resize(count, dimension());
  }                                   ///< resizes to a number of points of the same dimension
  void clear() { columns_.clear(); }  ///< the dimension stays
  /// Mutable view of point i.
  detail::listed_point<Eigen::Map<Eigen::VectorXd>> operator[](std::size_t i) {
    return {columns_[2 * i], columns_[2 * i + 1]};
  }
  /// Point i.
  detail::listed_point<Eigen::Map<const Eigen::VectorXd>> operator[](std::size_t i) const {
    return {columns_[2 * i], columns_[2 * i + 1]};
  }
  /// Behind those that there are, of their dimension.
  void push_back(const auto& x) {
    const Eigen::VectorXd p = x.p;  // x may be one of them
    columns_.push_back(x.q);
    columns_.push_back(p);
  }
  /// Appends the points of another list.
  void append(const phase_points& more) { columns_.append(more.columns_); }
  /// Puts a point, which has q and p, into a place.
  void set(std::size_t i, const auto& x) {
    columns_[2 * i] = x.q;
    columns_[2 * i + 1] = x.p;
  }
  auto begin() { return detail::list_iterator(this, 0); }           ///< begin iterator
  auto end() { return detail::list_iterator(this, size()); }        ///< end iterator
  auto begin() const { return detail::list_iterator(this, 0); }     ///< begin iterator
  auto end() const { return detail::list_iterator(this, size()); }  ///< end iterator
  /// Equal numbers.
  friend bool operator==(const phase_points&, const phase_points&) = default;

 private:
  detail::vector_list columns_;
};

}  // namespace nysalt
