/* hbvib.hpp - hbvib from C++17: RAII, exceptions, views without copies, lambdas.
 *
 * Header only; needs hbvib.h and the standard library. The mathematics, the meaning of every option and
 * the errors of every function stand in hbvib.h. A method has the name of the C function without its
 * prefix and its arguments in the same order, except that options which may be left out come last.
 *
 * Errors     A negative status is thrown as hbvib::Error. A positive one (stopped early) is none:
 *            Branch::status and Branch::complete say so. Destructors never throw.
 * Objects    Model and Branch are handles: they move and are not copied (Model::clone copies). One that
 *            was moved from may be assigned to or destroyed; all else gives Error with HBVIB_E_HANDLE.
 *            Its own calls keep an object alive, so a callback may even drop the model being solved.
 * Threads    As in the standard library: const methods may run at once on one object, others need it for
 *            themselves. hbvib_* calls on Model::get() obey hbvib.h.
 * Callbacks  May throw. The first exception of a call ends that call as soon as the library can stop, and
 *            leaves it as the same object, whatever the status. It is kept per call, so a callback may
 *            call the library, and catch what that throws. Only calls made through this header carry
 *            exceptions (shared objects that hide their symbols have one each): in a plain C call the
 *            force counts as failed, HBVIB_E_CALLBACK.
 * Memory     An array that a call only reads (In) may be a temporary. One that options keep (Span) must live until
 *            they were used. A View owns its share of the memory that it shows.
 */
#ifndef HBVIB_HPP
#define HBVIB_HPP

#include "hbvib.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <initializer_list>
#include <iterator>
#include <limits>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#if __cplusplus >= 202002L && __has_include(<ranges>)
#include <ranges>
#endif

namespace hbvib {

using Index = std::int64_t;
using Complex = std::complex<double>;

/// A negative status of the library. what() is its sentence: what is wrong, where, what is accepted.
class Error : public std::runtime_error {
 public:
  Error(hbvib_status status, std::int32_t argument, const std::string& sentence)
      : std::runtime_error(sentence), status_(status), argument_(argument) {}

  /// HBVIB_E_INDEX and so on.
  hbvib_status status() const noexcept { return status_; }
  /// Its name, "HBVIB_E_INDEX".
  const char* status_name() const noexcept { return hbvib_status_name(status_); }
  /// The parameter of the C function that is to blame, from 1; 0 where no single one is.
  std::int32_t argument() const noexcept { return argument_; }

 private:
  hbvib_status status_;
  std::int32_t argument_;
};

/// A value, or the Error in its place: the result of `attempt`, for programs that handle errors where they occur.
template <class T>
class Expected {
 public:
  using value_type = T;
  using error_type = Error;

  Expected(T value) : held_(std::in_place_index<0>, std::move(value)) {}
  Expected(Error error) : held_(std::in_place_index<1>, std::move(error)) {}

  bool has_value() const noexcept { return held_.index() == 0; }
  explicit operator bool() const noexcept { return has_value(); }
  /// The value; throws the Error where there is none.
  T& value() & { return check(), std::get<0>(held_); }
  const T& value() const& { return check(), std::get<0>(held_); }
  T&& value() && { return check(), std::get<0>(std::move(held_)); }
  T& operator*() & { return value(); }
  T&& operator*() && { return std::move(*this).value(); }
  T* operator->() { return &value(); }
  /// The Error; std::bad_variant_access where there is a value.
  const Error& error() const { return std::get<1>(held_); }
  template <class U>
  T value_or(U&& other) && {
    return has_value() ? std::get<0>(std::move(held_)) : static_cast<T>(std::forward<U>(other));
  }

 private:
  void check() const {
    if (!has_value()) throw std::get<1>(held_);
  }

  std::variant<T, Error> held_;
};

/// The result of a function as Expected: auto branch = hbvib::attempt([&] { return model.forced_response(...); }). Other
/// exceptions than Error pass.
template <class F, class T = std::invoke_result_t<F>>
Expected<std::conditional_t<std::is_void_v<T>, std::monostate, T>> attempt(F&& function) {
  try {
    if constexpr (std::is_void_v<T>) {
      std::forward<F>(function)();
      return std::monostate{};
    } else {
      return std::forward<F>(function)();
    }
  } catch (const Error& error) {
    return error;
  }
}

/// The sentence about this thread's last call of the C interface; empty after a success.
inline std::string last_error() {
  std::string text(hbvib_last_error_copy(nullptr, 0), '\0');
  hbvib_last_error_copy(&text[0], text.size());
  text.pop_back();
  return text;
}

namespace detail {

/// One call of the library by this thread. Callbacks leave their exception in the innermost one.
class Call {
 public:
  Call() noexcept : outer_(innermost()) { innermost() = this; }
  ~Call() { innermost() = outer_; }
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;

  bool threw() const noexcept { return thrown_ != nullptr; }

  /// Turns what happened into exceptions. To be called before anything else of the library.
  void done(Index result) {
    if (thrown_) std::rethrow_exception(std::exchange(thrown_, nullptr));
    if (result < 0) throw Error(static_cast<hbvib_status>(result), hbvib_last_error_argument(), hbvib_last_error());
  }
  /// The same for a call that has no points to keep: a stop is an Error (HBVIB_STOPPED_BY_CALLER).
  void done_whole(Index result) {
    done(result);
    if (result == HBVIB_STOPPED_BY_CALLER) throw Error(HBVIB_STOPPED_BY_CALLER, 0, hbvib_last_error());
  }

  /// Runs a callback; `failed` is the answer where it throws, or where one before it has thrown.
  template <class F>
  static std::int32_t guard(std::int32_t failed, F&& callback) noexcept {
    Call* call = innermost();
    if (call && call->running_) call = nullptr;  // in a plain C call that a callback makes: nobody carries it
    if (call && call->thrown_) return failed;
    if (call) call->running_ = true;
    std::int32_t answer = failed;
    try {
      answer = callback();
    } catch (...) {
      if (call) call->thrown_ = std::current_exception();
    }
    if (call) call->running_ = false;
    return answer;
  }

 private:
  static Call*& innermost() noexcept {
    thread_local Call* call = nullptr;
    return call;
  }

  Call* outer_;
  std::exception_ptr thrown_;
  bool running_ = false;  // a callback of this very call
};

/// Calls a function of the library that returns a status or a count.
template <class F, class... A>
auto call(F function, A... arguments) {
  Call frame;
  const auto result = function(arguments...);
  frame.done(result);
  return result;
}

/// Numbers in an array of the given lengths, 0 where one is not above 0: the library then says why.
inline std::size_t extent(Index a, Index b = 1) {
  if (a <= 0 || b <= 0) return 0;
  if (a > std::numeric_limits<Index>::max() / 16 / b) throw std::bad_array_new_length();
  return static_cast<std::size_t>(a * b);
}

/// The same where the library must see an array, however short.
inline std::size_t room(Index a, Index b = 1) { return std::max<std::size_t>(extent(a, b), 1); }

// Complex numbers are pairs of doubles ([complex.numbers]).
inline const double* flat(const Complex* x) noexcept { return reinterpret_cast<const double*>(x); }
inline double* flat(Complex* x) noexcept { return reinterpret_cast<double*>(x); }

/// Refuses an array whose length does not fit; one that may be left out may be empty.
inline void check_length(std::size_t size, Index needed, std::int32_t argument, const char* name, bool optional = false) {
  if (static_cast<Index>(size) == needed || (optional && size == 0)) return;
  throw Error(HBVIB_E_DIMENSION, argument,
              std::string(name) + " has " + std::to_string(size) + " entries, needs " + std::to_string(needed));
}

// Whether the numbers of a container lie one after the other: Eigen's blocks and views need not.
template <class C>
auto is_packed(const C& c, int) -> decltype(c.innerStride() == c.outerStride()) {
  const auto inner = C::IsRowMajor ? c.cols() : c.rows(), outer = C::IsRowMajor ? c.rows() : c.cols();
  return (inner <= 1 || c.innerStride() == 1) && (inner == 0 || outer <= 1 || c.outerStride() == inner);
}
template <class C>
auto is_packed(const C& c, int) -> decltype(c.is_packed()) {
  return c.is_packed();
}
template <class C>
bool is_packed(const C&, long) {
  return true;
}

template <class C>
using element = std::remove_pointer_t<decltype(std::declval<C&>().data())>;
template <class C, class T>  // a container of T with data() and size(), where T* may point
using holds = std::enable_if_t<std::is_convertible_v<element<C> (*)[], T (*)[]> &&
                               std::is_convertible_v<decltype(std::declval<C&>().size()), std::size_t>>;
template <class T>
using number = std::enable_if_t<std::is_same_v<T, double> || std::is_same_v<T, Complex>, T>;

}  // namespace detail

/// A borrowed array: a pointer and a length, from anything that has data() and size().
/// Error (HBVIB_E_ARGUMENT) for a container whose numbers do not lie one after the other.
template <class T>
class Span {
 public:
  constexpr Span() noexcept = default;
  /// Without length there is no data: an optional array that is empty is left out.
  constexpr Span(T* data, std::size_t size) noexcept : data_(size ? data : nullptr), size_(size) {}
  template <std::size_t N>
  constexpr Span(T (&array)[N]) noexcept : Span(array, N) {}
  template <class U, class = std::enable_if_t<std::is_convertible_v<U (*)[], T (*)[]>>>
  constexpr Span(const Span<U>& other) noexcept : Span(other.data(), other.size()) {}
  /// No temporaries: their content would be gone.
  template <class C, class = detail::holds<C, T>>
  Span(C& container) : Span(container.data(), static_cast<std::size_t>(container.size())) {
    if (!detail::is_packed(container, 0))
      throw Error(HBVIB_E_ARGUMENT, 0, "the array has gaps between its numbers, needs them one after the other");
  }

  constexpr T* data() const noexcept { return data_; }
  constexpr std::size_t size() const noexcept { return size_; }
  constexpr bool empty() const noexcept { return size_ == 0; }
  constexpr T* begin() const noexcept { return data_; }
  constexpr T* end() const noexcept { return data_ + size_; }
  constexpr T& operator[](std::size_t i) const { return data_[i]; }
  /// The length as the C interface wants it.
  constexpr Index length() const noexcept { return static_cast<Index>(size_); }

 private:
  T* data_ = nullptr;
  std::size_t size_ = 0;
};

/// An array that a call reads and forgets: a Span that takes temporaries and {lists} too.
template <class T>
class In : public Span<const T> {
 public:
  using Span<const T>::Span;
  In() noexcept = default;
  In(std::initializer_list<T> list) noexcept : Span<const T>(list.begin(), list.size()) {}
  template <class C, class = detail::holds<const C, const T>>
  In(const C& container) : Span<const T>(container) {}
};

/// An array of one to three dimensions with strides, both counted in numbers. Copies are cheap and share
/// the memory, which lives as long as the branch or any view of it.
template <class T>
class View {
 public:
  using Shape = std::array<Index, 3>;

  View() noexcept = default;
  View(T* data, int rank, const Shape& shape, const Shape& stride, std::shared_ptr<const void> owner = nullptr)
      : owner_(std::move(owner)), data_(data), rank_(rank), shape_(shape), stride_(stride) {}
  /// Row-major and packed; without numbers where data is null.
  View(T* data, std::initializer_list<Index> lengths, std::shared_ptr<const void> owner = nullptr)
      : owner_(std::move(owner)), data_(data), rank_(static_cast<int>(lengths.size())), shape_{1, 1, 1} {
    std::copy(lengths.begin(), lengths.end(), shape_.begin());
    if (!data_) shape_[0] = 0;
    stride_ = {shape_[1] * shape_[2], shape_[2], 1};
  }
  template <class U, class = std::enable_if_t<std::is_convertible_v<U (*)[], T (*)[]>>>
  View(const View<U>& other)
      : View(other.data(), other.rank(), other.shape(), other.stride(), other.owner()) {}

  T* data() const noexcept { return data_; }
  int rank() const noexcept { return rank_; }
  /// Lengths, 1 beyond the rank.
  const Shape& shape() const noexcept { return shape_; }
  Index shape(int dimension) const { return shape_.at(static_cast<std::size_t>(dimension)); }
  /// Distances of neighbours.
  const Shape& stride() const noexcept { return stride_; }
  Index stride(int dimension) const { return stride_.at(static_cast<std::size_t>(dimension)); }
  std::size_t size() const noexcept { return static_cast<std::size_t>(shape_[0] * shape_[1] * shape_[2]); }
  bool empty() const noexcept { return size() == 0; }
  const std::shared_ptr<const void>& owner() const noexcept { return owner_; }
  /// Whether the numbers lie one after the other, the last index running fastest.
  bool is_packed() const noexcept {
    return size() == 0 || ((shape_[2] == 1 || stride_[2] == 1) && (shape_[1] == 1 || stride_[1] == shape_[2]) &&
                           (shape_[0] == 1 || stride_[0] == shape_[1] * shape_[2]));
  }

  T& operator()(Index i, Index j = 0, Index k = 0) const { return data_[i * stride_[0] + j * stride_[1] + k * stride_[2]]; }
  T& operator[](Index i) const { return (*this)(i); }
  /// The same with the indices checked: std::out_of_range.
  T& at(Index i, Index j = 0, Index k = 0) const {
    const Shape index = {i, j, k};
    for (std::size_t d = 0; d < 3; d++)
      if (index[d] < 0 || index[d] >= shape_[d])
        throw std::out_of_range("index " + std::to_string(d) + " = " + std::to_string(index[d]) + " of a view, needs 0 .. " +
                                std::to_string(shape_[d] - 1));
    return (*this)(i, j, k);
  }

  class Iterator {
   public:
    using iterator_category = std::random_access_iterator_tag;
    using value_type = std::remove_const_t<T>;
    using difference_type = std::ptrdiff_t;
    using pointer = T*;
    using reference = T&;

    Iterator() = default;
    Iterator(T* data, Index stride, Index place) : data_(data), stride_(stride), place_(place) {}
    reference operator*() const { return data_[place_ * stride_]; }
    pointer operator->() const { return &**this; }
    reference operator[](difference_type n) const { return data_[(place_ + n) * stride_]; }
    Iterator& operator+=(difference_type n) { return place_ += n, *this; }
    Iterator& operator-=(difference_type n) { return *this += -n; }
    Iterator& operator++() { return *this += 1; }
    Iterator& operator--() { return *this += -1; }
    Iterator operator++(int) { return std::exchange(*this, *this + 1); }
    Iterator operator--(int) { return std::exchange(*this, *this - 1); }
    friend Iterator operator+(Iterator a, difference_type n) { return a += n; }
    friend Iterator operator+(difference_type n, Iterator a) { return a += n; }
    friend Iterator operator-(Iterator a, difference_type n) { return a -= n; }
    friend difference_type operator-(const Iterator& a, const Iterator& b) { return a.place_ - b.place_; }
    friend bool operator==(const Iterator& a, const Iterator& b) { return a.place_ == b.place_; }
    friend bool operator!=(const Iterator& a, const Iterator& b) { return a.place_ != b.place_; }
    friend bool operator<(const Iterator& a, const Iterator& b) { return a.place_ < b.place_; }
    friend bool operator>(const Iterator& a, const Iterator& b) { return b < a; }
    friend bool operator<=(const Iterator& a, const Iterator& b) { return !(b < a); }
    friend bool operator>=(const Iterator& a, const Iterator& b) { return !(a < b); }

   private:
    T* data_ = nullptr;
    Index stride_ = 1, place_ = 0;
  };
  /// Views of one dimension only: std::logic_error for others.
  Iterator begin() const { return {data_, stride_[0], line(0)}; }
  Iterator end() const { return {data_, stride_[0], line(shape_[0])}; }

 private:
  Index line(Index place) const {
    if (rank_ > 1) throw std::logic_error("a view of " + std::to_string(rank_) + " dimensions has no iterators, needs 1");
    return place;
  }

  std::shared_ptr<const void> owner_;
  T* data_ = nullptr;
  int rank_ = 1;
  Shape shape_ = {0, 1, 1}, stride_ = {1, 1, 1};
};

namespace detail {

/// A packed array of its own, to be written through the pointer and then shown by a view.
template <class T>
struct Array {
  explicit Array(std::size_t size) : numbers(std::make_shared<std::vector<T>>(size)) {}
  T* data() const { return numbers->empty() ? nullptr : numbers->data(); }
  Index length() const { return static_cast<Index>(numbers->size()); }
  View<const T> view(std::initializer_list<Index> lengths) const { return {data(), lengths, numbers}; }
  std::shared_ptr<std::vector<T>> numbers;
};

}  // namespace detail

/// A struct of the C interface, filled by its _init function.
template <class Struct, hbvib_status (*init)(Struct*, std::size_t)>
struct Filled : Struct {
  Filled() : Struct() { detail::call(init, static_cast<Struct*>(this), sizeof(Struct)); }
};

using SolverOptions = Filled<hbvib_solver_options, hbvib_solver_options_init>;
using SynthesisOptions = Filled<hbvib_synthesis_options, hbvib_synthesis_options_init>;
using RunUpOptions = Filled<hbvib_run_up_options, hbvib_run_up_options_init>;
using MissionOptions = Filled<hbvib_mission_options, hbvib_mission_options_init>;
using CampbellOptions = Filled<hbvib_campbell_options, hbvib_campbell_options_init>;
using SweepInfo = Filled<hbvib_sweep_info, hbvib_sweep_info_init>;
using LifeInfo = Filled<hbvib_life_info, hbvib_life_info_init>;
using BestLoad = Filled<hbvib_best_load, hbvib_best_load_init>;
using Reduction = Filled<hbvib_reduction, hbvib_reduction_init>;
using Energy = Filled<hbvib_energy, hbvib_energy_init>;
using ContactSummary = Filled<hbvib_contact_summary, hbvib_contact_summary_init>;
using ModePoint = Filled<hbvib_mode_point, hbvib_mode_point_init>;
using ModeInfo = Filled<hbvib_mode_info, hbvib_mode_info_init>;
using Descent = Filled<hbvib_descent, hbvib_descent_init>;
using Searched = Filled<hbvib_searched, hbvib_searched_init>;
using TimeInfo = Filled<hbvib_time_info, hbvib_time_info_init>;
using VerifyOptions = Filled<hbvib_verify_options, hbvib_verify_options_init>;
using VerificationInfo = Filled<hbvib_verification, hbvib_verification_init>;
using FloquetOptions = Filled<hbvib_floquet_options, hbvib_floquet_options_init>;
using FloquetInfo = Filled<hbvib_floquet_info, hbvib_floquet_info_init>;
using Kick = Filled<hbvib_kick, hbvib_kick_init>;
using DamperFace = Filled<hbvib_damper_face, hbvib_damper_face_init>;
using Damper = Filled<hbvib_damper, hbvib_damper_init>;
using BandOptions = Filled<hbvib_band_options, hbvib_band_options_init>;
using BandInfo = Filled<hbvib_band_info, hbvib_band_info_init>;
using Unknown = Filled<hbvib_unknown, hbvib_unknown_init>;
using FitOptions = Filled<hbvib_fit_options, hbvib_fit_options_init>;
using FitInfo = Filled<hbvib_fit_info, hbvib_fit_info_init>;
using FitProfileInfo = Filled<hbvib_fit_profile_info, hbvib_fit_profile_info_init>;
using JacobianGap = Filled<hbvib_jacobian_gap, hbvib_jacobian_gap_init>;

/// Range and rate of a sweep in time. A guess handed in is borrowed until the sweep.
struct SweepOptions : Filled<hbvib_sweep_options, hbvib_sweep_options_init> {
  SweepOptions() = default;
  SweepOptions(double from, double to, double per_time) { omega_start = from, omega_stop = to, rate = per_time; }
  /// Start values of the first periodic motion, (H + 1) x ndof.
  SweepOptions& start_from(Span<const Complex> x) { return start = detail::flat(x.data()), start_len = x.length(), *this; }
};

/// Contacts that wear, and the vibration that wears them. Arrays handed in are borrowed until the life was followed.
struct LifeOptions : Filled<hbvib_life_options, hbvib_life_options_init> {
  LifeOptions() = default;
  /// Contacts, and the worn volume per work of each.
  LifeOptions(Span<const Index> which, Span<const double> volumes) {
    contacts = which.data(), contacts_len = which.length(), rates = volumes.data();
    if (volumes.length() != which.length()) throw Error(HBVIB_E_DIMENSION, 2, "contacts and rates differ in length");
  }
  /// The peak between two angular frequencies, as it moves.
  LifeOptions& peak(double from, double to) {
    return follow = HBVIB_LIFE_PEAK, omega_start = from, omega_stop = to, *this;
  }
  /// Vibrations at angular frequencies.
  LifeOptions& at(Span<const double> omega) {
    return follow = HBVIB_LIFE_DUTIES, duty_omega = omega.data(), duties_len = omega.length(), *this;
  }
  /// Static stiffness between the normals of the contacts, contacts x contacts.
  LifeOptions& coupled(Span<const double> s) {
    if (s.length() != contacts_len * contacts_len) throw Error(HBVIB_E_DIMENSION, 1, "stiffness needs contacts x contacts numbers");
    return stiffness = s.data(), *this;
  }
};

/// Data of a test. Arrays handed in are borrowed until the fit.
struct DataSet : Filled<hbvib_data, hbvib_data_init> {
  DataSet() = default;
  /// Complex amplitudes at angular frequencies, under a factor on the forces.
  DataSet(Span<const double> omega, Span<const Complex> amplitudes, Span<const double> deviations, double force = 1) {
    n = omega.length(), x = omega.data(), value = detail::flat(amplitudes.data()), sigma = deviations.data(), force_factor = force;
    if (amplitudes.length() != n || deviations.length() != n) throw Error(HBVIB_E_DIMENSION, 2, "x, value and sigma differ in length");
  }
};

/// Range of a forced response, rad per time unit. Arrays handed in are borrowed until it was solved.
struct ForcedOptions : Filled<hbvib_forced_options, hbvib_forced_options_init> {
  ForcedOptions() = default;
  ForcedOptions(double start, double stop) { omega_start = start, omega_stop = stop; }
  /// Angular frequencies at which every solution is computed exactly.
  ForcedOptions& wanted(Span<const double> omega) { return at = omega.data(), at_len = omega.length(), *this; }
  /// Start values, (H + 1) x ndof.
  ForcedOptions& start_from(Span<const Complex> x) { return guess = detail::flat(x.data()), guess_len = x.length(), *this; }
};

/// Range of the responses of a batch, rad per time unit, and its threads.
struct BatchOptions : Filled<hbvib_batch_options, hbvib_batch_options_init> {
  BatchOptions() = default;
  BatchOptions(double start, double stop, std::int32_t number_of_threads = 1) { omega_start = start, omega_stop = stop, threads = number_of_threads; }
};

/// Range of a nonlinear mode, log10 of amplitudes. Arrays handed in are borrowed until it was solved.
struct ModeOptions : Filled<hbvib_mode_options, hbvib_mode_options_init> {
  ModeOptions() = default;
  ModeOptions(double start, double stop) { log10_start = start, log10_stop = stop; }
  /// log10 of the amplitudes at which every solution is computed exactly.
  ModeOptions& wanted(Span<const double> amplitudes) { return at = amplitudes.data(), at_len = amplitudes.length(), *this; }
  /// The linear mode most alike this one, ndof numbers.
  ModeOptions& alike(Span<const Complex> x) { return shape = detail::flat(x.data()), shape_len = x.length(), *this; }
  /// Motion near the first point, (H + 1) x ndof of any H, with its angular frequency and damping ratio.
  ModeOptions& start_from(Span<const Complex> x, double omega, double damping) {
    guess = detail::flat(x.data()), guess_len = x.length(), guess_omega = omega, guess_damping = damping;
    return *this;
  }
};

/// Options of a response in time. Arrays handed in are borrowed until it was solved.
struct TimeOptions : Filled<hbvib_time_options, hbvib_time_options_init> {
  TimeOptions() = default;
  explicit TimeOptions(double angular_frequency) { omega = angular_frequency; }
  /// Motion to start from, (H + 1) x ndof of any H.
  TimeOptions& start_from(Span<const Complex> x) { return start = detail::flat(x.data()), start_len = x.length(), *this; }
};

/// A sector with degrees of freedom on both faces. Arrays handed in are borrowed until the model was made.
struct Sector : Filled<hbvib_sector, hbvib_sector_init> {
  Sector() = default;
  Sector(Index degrees, Index number, Index order) { ndof = degrees, sectors = number, engine_order = order; }
  /// Degrees of freedom of both faces, node after node; -1 where a component is missing.
  Sector& faces(Span<const Index> l, Span<const Index> r, Index per_node = 3) {
    left = l.data(), left_len = l.length(), right = r.data(), right_len = r.length(), components = per_node;
    return *this;
  }
  Sector& fix(Span<const Index> dofs) { return fixed = dofs.data(), fixed_len = dofs.length(), *this; }
  /// Any frame that turns with the sector, as r, theta, z at each node.
  Sector& cylindrical() { return frame = HBVIB_CYLINDRICAL, *this; }
  /// Axis of the wheel through the origin, and the sense about it in which sectors follow.
  Sector& about(std::array<double, 3> along, int sense = 1) {
    std::copy(along.begin(), along.end(), axis);
    return direction = sense, *this;
  }
  /// Positions of the nodes of both faces, three numbers each, which are then checked.
  Sector& nodes_at(Span<const double> l, Span<const double> r) {
    detail::check_length(l.size(), 3 * left_len / components, 1, "left_coordinates");
    detail::check_length(r.size(), 3 * right_len / components, 1, "right_coordinates");
    return left_coordinates = l.data(), right_coordinates = r.data(), *this;
  }
};

/// A contact; the functions below set what their kind needs. b may be HBVIB_GROUND, offset is the sector
/// of side b over that of side a.
struct Contact : Filled<hbvib_contact, hbvib_contact_init> {
  using Dofs = std::array<Index, 3>;

  Contact() = default;
  explicit Contact(hbvib_contact_kind law) { kind = law; }
  Contact(hbvib_contact_kind law, const Dofs& a, const Dofs& b, Index offset = 0) : Contact(law) {
    std::copy(a.begin(), a.end(), dof_a);
    std::copy(b.begin(), b.end(), dof_b);
    sector_offset = offset;
  }
  static Contact jenkins(Index a, Index b, double kt, double mu, double preload, Index offset = 0) {
    return Contact(HBVIB_JENKINS, {a, HBVIB_GROUND, HBVIB_GROUND}, {b, HBVIB_GROUND, HBVIB_GROUND}, offset).with(kt, 0, mu, preload, 0);
  }
  /// a and b: along t1, t2 (HBVIB_GROUND for HBVIB_FRICTION_2D) and n.
  static Contact friction(hbvib_contact_kind law, const Dofs& a, const Dofs& b, double kt, double kn, double mu, double preload,
                          double gap = 0, Index offset = 0) {
    return Contact(law, a, b, offset).with(kt, kn, mu, preload, gap);
  }
  static Contact unilateral(Index a, Index b, double kn, double gap, double preload = 0, Index offset = 0) {
    return Contact(HBVIB_UNILATERAL, {HBVIB_GROUND, HBVIB_GROUND, a}, {HBVIB_GROUND, HBVIB_GROUND, b}, offset).with(0, kn, 0, preload, gap);
  }
  static Contact cubic_spring(Index a, Index b, double kt, double cubic, Index offset = 0) {
    Contact c = jenkins(a, b, kt, 0, 0, offset);
    return c.kind = HBVIB_CUBIC, c.cubic = cubic, c;
  }
  static Contact regularised(Index a, Index b, double mu, double preload, double velocity, Index offset = 0) {
    Contact c = jenkins(a, b, 0, mu, preload, offset);
    return c.kind = HBVIB_REGULARISED, c.velocity = velocity, c;
  }

 private:
  Contact with(double t, double n, double friction, double load, double opening) {
    return kt = t, kn = n, mu = friction, preload = load, gap = opening, *this;
  }
};

/// A matrix of the caller, borrowed for a call: real or complex, dense or sparse.
/// Number: double or std::complex<double>; any other is no Matrix.
struct Matrix : Filled<hbvib_matrix, hbvib_matrix_init> {
  /// Dense; leading: distance of columns (rows, if row-major) in numbers, 0 = packed.
  template <class Number, class = detail::number<Number>>
  Matrix(const Number* numbers, Index n_rows, Index n_cols, hbvib_storage order = HBVIB_COL_MAJOR, Index leading = 0) {
    set(numbers), storage = order, rows = n_rows, cols = n_cols, ld = leading;
  }
  /// A matrix written in C: row after row.
  template <class Number, std::size_t R, std::size_t C, class = detail::number<Number>>
  Matrix(const Number (&numbers)[R][C]) : Matrix(&numbers[0][0], R, C, HBVIB_ROW_MAJOR) {}
  /// Any dense class with data(), rows(), cols(), outerStride() and IsRowMajor: Eigen's matrices, maps and
  /// blocks. Error (HBVIB_E_ARGUMENT) where neighbours within a column (row) are not adjacent.
  template <class M, class = decltype(std::declval<const M&>().outerStride()),
            class Number = detail::number<std::remove_const_t<detail::element<const M>>>>
  Matrix(const M& m) : Matrix(m.data(), m.rows(), m.cols(), M::IsRowMajor ? HBVIB_ROW_MAJOR : HBVIB_COL_MAJOR, m.outerStride()) {
    if (!adjacent(m, 0)) throw Error(HBVIB_E_ARGUMENT, 0, "the matrix has gaps between the numbers of a column or row, needs them adjacent");
  }
  /// Compressed sparse columns, indices counted from `base`; indices of other types are copied.
  template <class Number, class I, class = detail::number<Number>>
  static Matrix csc(Index n_rows, Index n_cols, const Number* numbers, const I* col_ptr, const I* row_idx, int base = 0) {
    Matrix a(numbers, n_rows, n_cols, HBVIB_CSC);
    a.index_base = base;
    const std::size_t ends = detail::extent(n_cols) + 1;
    a.col_ptr = a.as_index(col_ptr, ends);
    a.row_idx = a.as_index(row_idx, col_ptr ? detail::extent(static_cast<Index>(col_ptr[ends - 1]) - base) : 0);
    return a;
  }
  /// Compressed sparse rows, indices counted from `base`: copied to columns. Error (HBVIB_E_INDEX) for a column out of range.
  template <class Number, class I, class = detail::number<Number>>
  static Matrix csr(Index n_rows, Index n_cols, const Number* numbers, const I* row_ptr, const I* col_idx, int base = 0) {
    const std::size_t rows = detail::extent(n_rows), cols = detail::extent(n_cols);
    const auto entries = static_cast<std::size_t>(row_ptr[rows] - base);
    auto starts = std::make_shared<std::vector<Index>>(cols + 1, 0);
    auto row_of = std::make_shared<std::vector<Index>>(entries);
    auto sorted = std::make_shared<std::vector<Number>>(entries);
    for (std::size_t k = 0; k < entries; k++) {
      const Index column = static_cast<Index>(col_idx[k]) - base;
      if (column < 0 || column >= n_cols)
        throw Error(HBVIB_E_INDEX, 0, "col_idx[" + std::to_string(k) + "] = " + std::to_string(column + base) + ", needs " +
                                          std::to_string(base) + " .. " + std::to_string(n_cols - 1 + base));
      ++(*starts)[static_cast<std::size_t>(column) + 1];
    }
    for (std::size_t j = 0; j < cols; j++) (*starts)[j + 1] += (*starts)[j];
    std::vector<Index> next(starts->begin(), starts->end());
    for (std::size_t i = 0; i < rows; i++) {
      for (auto k = static_cast<std::size_t>(row_ptr[i] - base); k < static_cast<std::size_t>(row_ptr[i + 1] - base); k++) {
        const auto place = static_cast<std::size_t>(next[static_cast<std::size_t>(col_idx[k] - base)]++);
        (*row_of)[place] = static_cast<Index>(i), (*sorted)[place] = numbers[k];
      }
    }
    Matrix a(sorted->data(), n_rows, n_cols, HBVIB_CSC);
    a.col_ptr = starts->data(), a.row_idx = row_of->data();
    a.copies_ = {starts, row_of, sorted};
    return a;
  }
  /// Any compressed sparse class with valuePtr(), outerIndexPtr(), innerIndexPtr(): Eigen's, by columns as it is, by rows copied.
  template <class S, class = decltype(std::declval<const S&>().outerIndexPtr()), class = void, class = void>
  Matrix(const S& s) : Matrix(of_sparse(compressed(s))) {}
  /// The same matrix with another promise: HBVIB_GENERAL, HBVIB_SYMMETRIC_LOWER, ...
  Matrix as(hbvib_part given) const {
    Matrix a = *this;
    return a.part = given, a;
  }

 private:
  void set(const double* numbers) { values = numbers, scalar = HBVIB_REAL; }
  void set(const Complex* numbers) { values = detail::flat(numbers), scalar = HBVIB_COMPLEX; }
  const Index* as_index(const Index* indices, std::size_t) { return indices; }
  template <class I>
  const Index* as_index(const I* indices, std::size_t n) {
    if (!indices) return nullptr;
    auto copy = std::make_shared<const std::vector<Index>>(indices, indices + n);
    copies_.push_back(copy);
    return copy->data();
  }
  template <class S>
  static Matrix of_sparse(const S& s) {
    if constexpr (S::IsRowMajor)
      return csr(s.rows(), s.cols(), s.valuePtr(), s.outerIndexPtr(), s.innerIndexPtr());
    else
      return csc(s.rows(), s.cols(), s.valuePtr(), s.outerIndexPtr(), s.innerIndexPtr());
  }
  template <class S>
  static const S& compressed(const S& s) {
    if (s.isCompressed()) return s;
    throw Error(HBVIB_E_ARGUMENT, 0, "the sparse matrix is not compressed, needs makeCompressed()");
  }
  template <class M>
  static auto adjacent(const M& m, int) -> decltype(m.innerStride() == 1) {
    return m.innerStride() == 1 || (M::IsRowMajor ? m.cols() : m.rows()) <= 1;
  }
  template <class M>
  static bool adjacent(const M&, long) {
    return true;
  }

  std::vector<std::shared_ptr<const void>> copies_;
};

/// A parameter of a model, by which results are differentiated.
struct Parameter : Filled<hbvib_parameter, hbvib_parameter_init> {
  /// A factor on all forces, a constant of a contact (-1: of all that have it) or the speed of rotation.
  explicit Parameter(hbvib_parameter_kind which, Index of_contact = -1) { kind = which, contact = of_contact; }
  /// The coefficient of a direction that is added to the mass, damping or stiffness matrix; in a cyclic model to the
  /// block of the sector itself. The numbers of the direction are borrowed.
  Parameter(hbvib_parameter_kind which, const Matrix& added) : Parameter(which) {
    kept_ = std::make_shared<const Matrix>(added);
    direction = kept_.get();
  }
  /// A factor on the whole mass, damping or stiffness matrix with its couplings.
  static Parameter factor(hbvib_parameter_kind which) {
    Parameter p(which);
    return p.scaling = HBVIB_SCALING_FACTOR, p;
  }

 private:
  std::shared_ptr<const Matrix> kept_;
};

/// Range of a parameter response. Arrays handed in are borrowed until it was solved.
struct ParameterOptions : Filled<hbvib_parameter_options, hbvib_parameter_options_init> {
  ParameterOptions(const Parameter& changed, double from, double to, double frequency, hbvib_follow what = HBVIB_FOLLOW_OMEGA)
      : kept_(std::make_shared<const Parameter>(changed)) {
    parameter = kept_.get(), start = from, stop = to, omega = frequency, follow = what;
  }
  /// log10 of the modal amplitudes between which the maximum of damping is sought, with HBVIB_FOLLOW_MODE_MAX_DAMPING.
  ParameterOptions& amplitudes(double from, double to) { return log10_start = from, log10_stop = to, *this; }
  /// Values of the parameter at which every solution is computed exactly.
  ParameterOptions& wanted(Span<const double> values) { return at = values.data(), at_len = values.length(), *this; }

 private:
  std::shared_ptr<const Parameter> kept_;
};

/// A callable that may return nothing where R is required: then it returns R{}.
template <class R, class Argument>
class Callback : public std::function<R(Argument)> {
 public:
  Callback() = default;
  template <class F, class = std::enable_if_t<std::is_invocable_v<F&, Argument> && !std::is_base_of_v<Callback, F>>>
  Callback(F callable) : std::function<R(Argument)>(answering(std::move(callable))) {}

 private:
  template <class F>
  static std::function<R(Argument)> answering(F callable) {
    if constexpr (std::is_void_v<std::invoke_result_t<F&, Argument>>) {
      std::function<void(Argument)> inner(std::move(callable));
      if (!inner) return {};  // an empty function stays one
      return [inner = std::move(inner)](Argument argument) { return inner(argument), R{}; };
    } else {
      return std::function<R(Argument)>(std::move(callable));
    }
  }
};

class Branch;

/// Callbacks and cancel flag of a solve. An exception of a callback leaves the solve as it was thrown; one of
/// `log` at the next point found.
struct Hooks {
  /// Called at each point; returns nothing, or true to stop and keep the points.
  Callback<bool, const hbvib_progress&> progress{};
  /// Receives log lines; the text is valid during the call.
  std::function<void(hbvib_log_level, const char*)> log{};
  /// The finest lines that `log` wants.
  hbvib_log_level log_level = HBVIB_LOG_INFO;
  /// Nonzero stops the solve and keeps the points; other threads and signal handlers may set it.
  const std::atomic<std::int32_t>* cancel = nullptr;
  /// Receives what was found where a callback's exception ends a solve; an empty Branch if nothing was.
  Branch* partial = nullptr;
  /// Called with the phase and its share, from the set-up on; returns nothing, or true to stop.
  Callback<bool, const hbvib_phase_report&> phase{};
};

/// One period for which a force is computed, as views of N samples: f(j, i), df_du(j, i, k). Write f, z and
/// the derivatives that are not 0; those that the force has no use for are empty.
struct ForceCall {
  explicit ForceCall(const hbvib_force_call& c)
      : omega(c.omega), samples(c.samples), n(c.n), states(c.states), u(c.u, {samples, n}), v(c.v, {samples, n}),
        z0(c.z0, {states}), f(c.f, {samples, n}), df_du(c.df_du, {samples, n, n}), df_dv(c.df_dv, {samples, n, n}),
        z(c.z, {samples, states}), dz_dz(c.dz_dz, {samples, states, states}),
        dz_du_before(c.dz_du_before, {samples, states, n}), dz_du(c.dz_du, {samples, states, n}),
        dz_dv_before(c.dz_dv_before, {samples, states, n}), dz_dv(c.dz_dv, {samples, states, n}),
        dz_domega(c.dz_domega, {samples, states}), df_dz(c.df_dz, {samples, n, states}) {}

  double omega;
  Index samples, n, states;
  View<const double> u, v, z0;
  View<double> f, df_du, df_dv, z, dz_dz, dz_du_before, dz_du, dz_dv_before, dz_dv, dz_domega, df_dz;
};

/// A force of the caller; models and branches that need it share it. It may be called by several threads
/// at once where they use one model.
struct UserForce {
  std::vector<Index> dofs;
  /// Returns nothing or 0 when done; above 0: not at this motion; below 0, or an exception: stop.
  Callback<std::int32_t, const ForceCall&> force;
  bool uses_velocity = false, is_odd = false;
  Index states = 0, samples = 0;
};

namespace detail {

using Forces = std::vector<std::shared_ptr<const UserForce>>;

/// A handle, and the forces that the library may call as long as it lives.
template <class Handle, hbvib_status (*release)(Handle*)>
struct Owned {
  Owned() = default;
  Owned(const Owned&) = delete;
  Owned& operator=(const Owned&) = delete;
  ~Owned() { release(handle); }

  Handle* handle = nullptr;
  Forces forces;
};

/// Calls a function that takes hooks last and has no points to keep.
template <class F, class... A>
void call_whole(const Hooks& hooks, F function, A... arguments);

/// Common part of Model and Branch: shared only with calls that run, and with views.
template <class Handle, hbvib_status (*release)(Handle*)>
class Object {
 public:
  /// The C handle, borrowed: NULL after a move.
  Handle* get() const noexcept { return core_ ? core_->handle : nullptr; }
  explicit operator bool() const noexcept { return get() != nullptr; }

 protected:
  using Core = Owned<Handle, release>;
  Object() noexcept = default;
  explicit Object(std::shared_ptr<Core> core) noexcept : core_(std::move(core)) {}
  Object(Object&&) noexcept = default;
  Object& operator=(Object&&) noexcept = default;
  ~Object() = default;

  /// Calls a function that takes the handle first.
  template <class F, class... A>
  auto use(F function, A... arguments) const {
    const auto keep = core_;
    return call(function, get(), arguments...);
  }
  /// The same with hooks, see call_whole.
  template <class F, class... A>
  void use_whole(const Hooks& hooks, F function, A... arguments) const {
    const auto keep = core_;
    call_whole(hooks, function, get(), arguments...);
  }

  std::shared_ptr<Core> core_;
};

/// Hooks as the library wants them; they live as long as the call.
struct BoundHooks : Filled<hbvib_hooks, hbvib_hooks_init> {
  explicit BoundHooks(const Hooks& hooks) {
    static_assert(sizeof(std::atomic<std::int32_t>) == sizeof(std::int32_t) && std::atomic<std::int32_t>::is_always_lock_free,
                  "the library reads the flag as a plain number");
    user = const_cast<Hooks*>(&hooks);
    progress = on_progress;
    phase = on_phase;
    if (hooks.log) log = on_log, log_level = hooks.log_level;
    cancel = reinterpret_cast<const hbvib_cancel_flag*>(hooks.cancel);
  }

 private:
  static std::int32_t on_progress(void* user, const hbvib_progress* p) noexcept {
    const auto& progress = static_cast<const Hooks*>(user)->progress;
    return Call::guard(1, [&] { return progress && progress(*p) ? 1 : 0; });
  }
  static std::int32_t on_phase(void* user, const hbvib_phase_report* p) noexcept {
    const auto& phase = static_cast<const Hooks*>(user)->phase;
    return Call::guard(1, [&] { return phase && phase(*p) ? 1 : 0; });
  }
  static void on_log(void* user, std::int32_t level, const char* line) noexcept {
    Call::guard(0, [&] { return static_cast<const Hooks*>(user)->log(static_cast<hbvib_log_level>(level), line), 0; });
  }
};

template <class F, class... A>
void call_whole(const Hooks& hooks, F function, A... arguments) {
  const BoundHooks bound(hooks);
  Call frame;
  frame.done_whole(function(arguments..., &bound));
}

inline std::int32_t on_force(void* user, const hbvib_force_call* period) noexcept {
  return Call::guard(-1, [&] { return static_cast<const UserForce*>(user)->force(ForceCall(*period)); });
}

}  // namespace detail

/// A peak, fold or requested solution; `point` is its number for the results of a branch.
struct Peak {
  double omega, amplitude;
  Index point;
};
/// A solution at a requested frequency or amplitude.
struct Wanted {
  double amplitude;
  Index point;
};
/// A contact over a period: relative motion, force and HBVIB_STATE_STICK and so on at n times.
struct ContactLoop {
  std::vector<double> motion, force;
  std::vector<std::int32_t> state;
};
/// A synthesised response, point by point.
struct Synthesis {
  std::vector<double> omega;
  std::vector<Complex> response;
  std::vector<double> modal_amplitude;
};
/// A synthesised resonance; flags is a sum of hbvib_synthesis_flag.
struct SynthesisPeak {
  double omega, amplitude, log10_amplitude, damping_ratio, other_mode, error;
  std::int32_t flags;
};
/// A run-up by the slow flow of a mode, turn by turn; the numbers are those of the largest displacement.
struct RunUp {
  std::vector<double> time, omega, amplitude, modal_amplitude;
  double largest, largest_omega, largest_time;
  double error;           ///< Relative error of the largest displacement; an estimate where nothing was integrated, NaN if unknown.
  double without_memory;  ///< The largest displacement without the memory of sliders.
  double steady;          ///< Amplitude of the highest steady resonance, NaN without one.
  double slow_flow;       ///< The largest displacement by the slow flow alone.
  Index integrated;       ///< Turns that were integrated in time; 0: none.
  double factor() const { return largest / steady; }
};
/// A passage of a mission through a resonance: its largest amplitude and the steady one, the cycles with at least 1/sqrt(2) of it.
struct Passage {
  double time, omega, rate, amplitude, steady, cycles;
};
/// A resonance over a mission.
struct Mission {
  std::vector<double> amplitude, cycles, damage;
  std::vector<Passage> passages;
  double error;
};
/// A sweep in time, turn by turn.
struct TimeSweep {
  std::vector<double> time, omega, amplitude;
  SweepInfo info;
  bool stopped;  ///< By a hook; the turns so far are kept.
};
/// A change of a contact over a life: kind is a hbvib_life_event, contact -1 for the amplitude.
struct LifeEvent {
  double cycles;
  Index kind, contact;
};
/// A life at the wanted cycles: depths, loads and works have a row of `contacts` numbers for each. NaN where a life that ended early,
/// with a positive status, did not come.
struct Life {
  Index contacts;
  std::vector<double> depths, loads, works, amplitude, omega;
  std::vector<LifeEvent> events;
  LifeInfo info;
  hbvib_status status;
};
/// Resonances of a mode in a Campbell diagram, a number for each factor on the forces; NaN where there is none.
struct CampbellResponse {
  std::vector<double> speed, omega, amplitude, damping_ratio, passed, error;
  double factor(std::size_t i) const { return passed[i] / amplitude[i]; }
};
/// Damped natural modes.
struct DampedModes {
  std::vector<Complex> eigenvalue;  ///< In the upper half plane, by rising imaginary part.
  View<const Complex> shapes;       ///< (mode, degree of freedom)
  std::vector<Index> direction;     ///< 1 forward, -1 backward, 0 undefined.
  double omega(std::size_t k) const { return eigenvalue[k].imag(); }
  double damping_ratio(std::size_t k) const { return -eigenvalue[k].real() / std::abs(eigenvalue[k]); }
};
/// An engine order at the frequency of a mode of the wave that it excites, whose signed nodal diameter is `diameter`.
struct Crossing {
  Index engine_order;
  double speed, omega;
  Index direction;
  Index diameter;
};
/// Damped modes over speeds: count numbers for each speed, one after the other.
struct Campbell {
  Index count;
  std::vector<double> omega, damping_ratio;
  std::vector<Index> direction;
  std::vector<Crossing> crossings;
};
/// Damped modes of all waves of a wheel: signed nodal diameters, and count numbers for each, one after the other.
struct Interference {
  Index count;
  std::vector<Index> diameters;
  std::vector<double> omega, damping_ratio;
  std::vector<Index> direction;
  bool equal_senses;  ///< The waves d and -d have the same frequencies and damping ratios.
};
/// Natural angular frequencies, and shapes count x ndof.
struct LinearModes {
  std::vector<double> omega;
  View<const Complex> shapes;
};
/// A periodic response in time: harmonics (H + 1) x ndof, samples x ndof displacements.
struct TimeResponse {
  hbvib_status status;
  View<const Complex> harmonics;
  View<const double> samples;
  TimeInfo info;
};
/// A point against the motion in time: the harmonics of that motion, (H + 1) x ndof, and what each harmonic adds to
/// info.motion_error, by squares.
struct Verification {
  hbvib_status status;
  View<const Complex> harmonics;
  std::vector<double> errors;
  VerificationInfo info;

  /// Fundamental of the response degree of freedom in time.
  Complex response() const { return {info.response[0], info.response[1]}; }
};
/// A bifurcation of a forced response, with the numbers of unstable directions before and after it, -1 where unknown.
struct Bifurcation {
  double omega, amplitude;
  hbvib_bifurcation kind;
  Index point, unstable_before, unstable_after;
};
/// A motion without forces: a point of a nonlinear mode where the damping ratio is zero, with its slope by log10_amplitude.
struct LimitCycle {
  double omega, log10_amplitude, slope;
  Index point;
};
/// An optimum of the amplitude over a parameter.
struct Optimum {
  double parameter, amplitude;
  bool is_maximum;
  Index point;
};
/// A point at which a parameter response turns over the parameter, which is largest there, or smallest.
struct Turn {
  double parameter, omega, amplitude;
  bool is_maximum;
  Index point;
};
/// A peak that is higher than the followed one of a parameter response, and the point number of that one.
struct HigherPeak {
  double parameter, omega, amplitude;
  Index point;
};
/// A slider that sticks through the period and changes the vibration, its place, and the derivative of the amplitude by it.
struct FreeSlider {
  Index contact, direction;
  double place, derivative;
};
/// Static states along a load history: displacements of each step, places of the sliders along t1 and t2 of each contact, and forces along
/// t1, t2 and n of each contact, step after step.
struct StaticHistory {
  Index steps;
  std::vector<double> motion, places, forces;
};
/// The band of a result over residual forces: numbers, free sliders as contact and direction, and their places at both ends, for
/// Model::set_slider.
struct Band {
  BandInfo info;
  std::vector<Index> contact, direction;
  std::vector<double> lower_place, upper_place;
};
/// Lower and upper curve of a response over its residual forces: angular frequency, both, free sliders, and whether the search of each
/// point ended.
struct BandCurve {
  std::vector<double> omega, lower, upper;
  std::vector<Index> sliders, complete;
};
/// The band of damping ratio or frequency of a nonlinear mode: numbers, free sliders, and their places at both ends.
struct ModeBand {
  BandInfo info;
  std::vector<Index> contact, direction;
  std::vector<double> lower_place, upper_place;
};
/// Degrees of freedom and contacts of a damper in its model: the first ones, which the others follow.
struct DamperPlace {
  Index dof, contact;
};
/// Multipliers of one period of a motion by falling modulus, and the reason of each.
struct Floquet {
  hbvib_status status;
  std::vector<Complex> multipliers;
  std::vector<hbvib_multiplier_class> classes;
  FloquetInfo info;
};
/// Derivatives of a result by parameters, in their order. Those that do not exist are NaN, and `reasons` tells why;
/// onset is the contact at the onset of slip, or -1.
struct Sensitivities {
  std::vector<double> derivatives;
  std::vector<hbvib_derivative> reasons;
  Index onset;
};
/// Derivatives of a complex amplitude by parameters at a fixed frequency.
struct ComplexSensitivities {
  Complex value, by_omega;
  std::vector<Complex> derivatives;
  std::vector<hbvib_derivative> reasons;
  Index onset;
};
/// Values of parameters with their covariance, row after row, and residuals and values of the model, two numbers for each data point.
struct Fit {
  FitInfo info;
  std::vector<double> theta, covariance, residuals, values;
};
/// A pattern from measured modes with its covariance, row after row; chi2 is about `degrees` where noise is all that is left.
struct IdentifiedPattern {
  std::vector<double> delta, covariance;
  double chi2;
  Index degrees;
};
/// Least loss at values of one parameter, NaN where no fit was found, and the values of all parameters there, row after row.
struct FitProfile {
  FitProfileInfo info;
  std::vector<double> loss, theta;
  bool stopped;
};
/// Predicted numbers, two for each x, with their standard deviations and the shift of their means by the second order.
struct Predicted {
  std::vector<double> values, sigma, shift;
};
/// Residual of n complex rows; jacobian is 2 n x 2 n over the pairs (re, im). Both derivatives are empty
/// unless requested.
struct Residual {
  std::vector<Complex> r;
  View<const double> jacobian;
  std::vector<Complex> d_omega;
};
/// Force harmonics of a contact law, direction after direction; jacobian is empty unless requested.
struct ContactForce {
  std::vector<Complex> force;
  View<const double> jacobian;
};

class Model;

/// A point of the curve of a branch: its number for the results of the branch, and both fields.
struct CurvePoint {
  Index point;
  double omega, amplitude;
};

/// Goes over the points of a curve, which it makes of the fields of the branch. It keeps their memory alive.
class CurveIterator {
 public:
  using iterator_concept = std::random_access_iterator_tag;
  using iterator_category = std::input_iterator_tag;  // C++17 wants a reference of the others
  using value_type = CurvePoint;
  using difference_type = std::ptrdiff_t;
  using pointer = void;
  using reference = CurvePoint;

  CurveIterator() noexcept = default;
  CurveIterator(View<const double> omega, View<const double> amplitude, Index place)
      : omega_(std::move(omega)), amplitude_(std::move(amplitude)), place_(place) {}
  CurvePoint operator*() const { return (*this)[0]; }
  CurvePoint operator[](difference_type n) const { return {place_ + n, omega_[place_ + n], amplitude_[place_ + n]}; }
  CurveIterator& operator+=(difference_type n) { return place_ += n, *this; }
  CurveIterator& operator-=(difference_type n) { return *this += -n; }
  CurveIterator& operator++() { return *this += 1; }
  CurveIterator& operator--() { return *this += -1; }
  CurveIterator operator++(int) { return std::exchange(*this, *this + 1); }
  CurveIterator operator--(int) { return std::exchange(*this, *this - 1); }
  friend CurveIterator operator+(CurveIterator a, difference_type n) { return a += n; }
  friend CurveIterator operator+(difference_type n, CurveIterator a) { return a += n; }
  friend CurveIterator operator-(CurveIterator a, difference_type n) { return a -= n; }
  friend difference_type operator-(const CurveIterator& a, const CurveIterator& b) { return a.place_ - b.place_; }
  friend bool operator==(const CurveIterator& a, const CurveIterator& b) { return a.place_ == b.place_; }
  friend bool operator!=(const CurveIterator& a, const CurveIterator& b) { return a.place_ != b.place_; }
  friend bool operator<(const CurveIterator& a, const CurveIterator& b) { return a.place_ < b.place_; }
  friend bool operator>(const CurveIterator& a, const CurveIterator& b) { return b < a; }
  friend bool operator<=(const CurveIterator& a, const CurveIterator& b) { return !(b < a); }
  friend bool operator>=(const CurveIterator& a, const CurveIterator& b) { return !(a < b); }

 private:
  View<const double> omega_, amplitude_;
  Index place_ = 0;
};

/// A branch of solutions. Its points never change, so that all methods are const and may run at once; it is a range of the points of its
/// curve: for (const auto p : branch).
/// Results may call user forces again, whose exceptions leave them as well.
class Branch : public detail::Object<hbvib_branch, hbvib_branch_free> {
 public:
  /// No branch.
  Branch() noexcept = default;

  /// HBVIB_OK, or why the solve stopped early.
  [[nodiscard]] hbvib_status status() const { return use(hbvib_branch_status); }
  /// Whether the whole range was covered.
  [[nodiscard]] bool complete() const { return status() == HBVIB_OK; }
  /// The sentence that belongs to the status; empty where it is complete.
  std::string sentence() const { return static_cast<void>(status()), last_error(); }
  /// Points on the curve.
  Index points() const { return use(hbvib_branch_points); }
  /// The points of the curve as a range; in C++20 one with random access.
  CurveIterator begin() const { return {field(HBVIB_OMEGA), field(HBVIB_AMPLITUDE), 0}; }
  CurveIterator end() const { return {field(HBVIB_OMEGA), field(HBVIB_AMPLITUDE), points()}; }
  /// All stored points: the curve, then peaks, folds and requested solutions.
  Index stored() const { return use(hbvib_branch_stored); }
  /// A field of the curve where it lies, without a copy: points, or points x contacts.
  View<const double> field(hbvib_field which) const {
    Filled<hbvib_view, hbvib_view_init> v;
    use(hbvib_branch_field, which, &v);
    if (v.scalar != HBVIB_REAL) throw Error(HBVIB_E_UNSUPPORTED, 2, "the field is complex: use hbvib_branch_field");
    return {v.data, v.rank, {v.shape[0], v.shape[1], v.shape[2]}, {v.stride[0], v.stride[1], v.stride[2]}, core_};
  }
  /// Harmonics of a range of degrees of freedom at a point, (H + 1) x n_dof; n_dof = -1: to the last.
  View<const Complex> harmonics(Index point, Index first_dof = 0, Index n_dof = -1, const Hooks& hooks = {}) const {
    const Reduction whole = reduction();
    const Index n = n_dof == -1 ? std::max<Index>(whole.degrees_of_freedom - first_dof, 1) : n_dof, rows = whole.harmonics_asked + 1;
    const detail::Array<Complex> x(detail::room(rows, n));
    harmonics(point, first_dof, n, Span<Complex>(x.data(), detail::extent(rows, n)), hooks);
    return x.view({rows, n});
  }
  /// The same into an array of the caller, harmonic after harmonic.
  void harmonics(Index point, Index first_dof, Index n_dof, Span<Complex> x, const Hooks& hooks = {}) const {
    use_whole(hooks, hbvib_branch_harmonics_with_hooks, point, first_dof, n_dof, detail::flat(x.data()), x.length());
  }
  /// Share of the period that each contact slips.
  std::vector<double> slip_fraction(Index point) const {
    std::vector<double> shares(detail::extent(reduction().contacts));
    use(hbvib_branch_slip_fraction, point, shares.data(), static_cast<Index>(shares.size()));
    return shares;
  }
  Reduction reduction() const { return filled<Reduction>(hbvib_branch_reduction); }
  /// Maxima of the amplitude; in a nonlinear mode of the damping ratio.
  std::vector<Peak> peaks() const { return extremes(hbvib_branch_peaks); }
  /// The highest of them; Error (HBVIB_E_INDEX) where there is none.
  Peak highest_peak() const {
    const auto all = peaks();
    if (all.empty()) throw Error(HBVIB_E_INDEX, 0, "the branch has no peak");
    return *std::max_element(all.begin(), all.end(), [](const Peak& a, const Peak& b) { return a.amplitude < b.amplitude; });
  }
  /// Turning points.
  std::vector<Peak> folds() const { return extremes(hbvib_branch_folds); }
  /// Folds and, with the solver option stability, the other points where a Floquet multiplier passes the unit circle.
  std::vector<Bifurcation> bifurcations() const {
    Index count = 0;
    use(hbvib_branch_bifurcations, 0, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr, &count);
    std::vector<double> omega(detail::extent(count)), amplitude(omega.size());
    std::vector<Index> kind(omega.size()), point(omega.size()), before(omega.size()), after(omega.size());
    use(hbvib_branch_bifurcations, count, omega.data(), amplitude.data(), kind.data(), point.data(), before.data(), after.data(), &count);
    std::vector<Bifurcation> out;
    for (std::size_t i = 0; i < omega.size(); i++)
      out.push_back({omega[i], amplitude[i], static_cast<hbvib_bifurcation>(kind[i]), point[i], before[i], after[i]});
    return out;
  }
  /// The branches that branch off from this one, and detached curves beside it, as far as the option branches sought them. Each keeps
  /// this branch alive.
  std::vector<Branch> children() const {
    std::vector<Branch> out;
    const Index count = use(hbvib_branch_children);
    for (Index number = 0; number < count; number++) {
      // The library frees a child with its parent.
      const auto keep = [parent = core_](Core* core) { core->handle = nullptr, delete core; };
      Branch child(std::shared_ptr<Core>(new Core, keep));
      use(hbvib_branch_child, number, &child.core_->handle);
      out.push_back(std::move(child));
    }
    return out;
  }
  /// Where a child comes from.
  Descent descent() const { return filled<Descent>(hbvib_branch_descent); }
  /// The solutions that were sought beside it; that list is never complete.
  Searched searched() const { return filled<Searched>(hbvib_branch_searched); }
  /// Minima and maxima of the amplitude over the parameter of a parameter response.
  std::vector<Optimum> optima() const {
    Index count = 0;
    use(hbvib_branch_optima, 0, nullptr, nullptr, nullptr, nullptr, &count);
    const std::size_t n = detail::extent(count);
    std::vector<double> parameter(n), amplitude(n);
    std::vector<std::int64_t> maximum(n), point(n);
    use(hbvib_branch_optima, count, parameter.data(), amplitude.data(), maximum.data(), point.data(), &count);
    std::vector<Optimum> out;
    for (std::size_t i = 0; i < n; i++) out.push_back({parameter[i], amplitude[i], maximum[i] == 1, point[i]});
    return out;
  }
  /// Points at which a parameter response turns over the parameter: forces at which a detached curve is born or merges.
  std::vector<Turn> turns() const {
    Index count = 0;
    use(hbvib_branch_turns, 0, nullptr, nullptr, nullptr, nullptr, nullptr, &count);
    const std::size_t n = detail::extent(count);
    std::vector<double> parameter(n), omega(n), amplitude(n);
    std::vector<Index> maximum(n), point(n);
    use(hbvib_branch_turns, count, parameter.data(), omega.data(), amplitude.data(), maximum.data(), point.data(), &count);
    std::vector<Turn> out;
    for (std::size_t i = 0; i < n; i++) out.push_back({parameter[i], omega[i], amplitude[i], maximum[i] == 1, point[i]});
    return out;
  }
  /// Peaks that are higher than the followed one of a parameter response, with the point numbers of that one.
  std::vector<HigherPeak> higher_peaks() const {
    Index count = 0;
    use(hbvib_branch_higher_peaks, 0, nullptr, nullptr, nullptr, nullptr, &count);
    const std::size_t n = detail::extent(count);
    std::vector<double> parameter(n), omega(n), amplitude(n);
    std::vector<Index> point(n);
    use(hbvib_branch_higher_peaks, count, parameter.data(), omega.data(), amplitude.data(), point.data(), &count);
    std::vector<HigherPeak> out;
    for (std::size_t i = 0; i < n; i++) out.push_back({parameter[i], omega[i], amplitude[i], point[i]});
    return out;
  }
  /// Points of a nonlinear mode where its damping ratio is zero.
  std::vector<LimitCycle> limit_cycles() const {
    Index count = 0;
    use(hbvib_branch_limit_cycles, 0, nullptr, nullptr, nullptr, nullptr, &count);
    std::vector<double> omega(detail::extent(count)), amplitude(omega.size()), slope(omega.size());
    std::vector<Index> point(omega.size());
    use(hbvib_branch_limit_cycles, count, omega.data(), amplitude.data(), slope.data(), point.data(), &count);
    std::vector<LimitCycle> out;
    for (std::size_t i = 0; i < omega.size(); i++) out.push_back({omega[i], amplitude[i], slope[i], point[i]});
    return out;
  }
  /// Every solution at entry `wanted` of the requested frequencies or amplitudes.
  std::vector<Wanted> at(Index wanted) const {
    Index count = 0;
    use(hbvib_branch_at, wanted, 0, nullptr, nullptr, &count);
    std::vector<double> amplitude(detail::extent(count));
    std::vector<Index> point(amplitude.size());
    use(hbvib_branch_at, wanted, count, amplitude.data(), point.data(), &count);
    std::vector<Wanted> all;
    for (std::size_t i = 0; i < point.size(); i++) all.push_back({amplitude[i], point[i]});
    return all;
  }
  Energy energy(Index point, const Hooks& hooks = {}) const {
    Energy out;
    use_whole(hooks, hbvib_branch_energy_with_hooks, point, &out);
    return out;
  }
  ContactSummary contact_summary(Index point, Index contact, const Hooks& hooks = {}) const {
    ContactSummary out;
    use_whole(hooks, hbvib_branch_contact_summary_with_hooks, point, contact, &out);
    return out;
  }
  ModePoint mode_point(Index point) const { return filled<ModePoint>(hbvib_branch_mode_point, point); }
  ModeInfo mode_info() const { return filled<ModeInfo>(hbvib_branch_mode_info); }
  /// Motion over a period at n times.
  std::vector<double> time_history(Index point, Index dof, Index n, const Hooks& hooks = {}) const {
    std::vector<double> x(detail::room(n));
    use_whole(hooks, hbvib_branch_time_history_with_hooks, point, dof, n, x.data());
    return x;
  }
  /// Hysteresis loop of a contact at n times.
  ContactLoop contact_loop(Index point, Index contact, Index direction, Index n, const Hooks& hooks = {}) const {
    const std::size_t room = detail::room(n);
    ContactLoop loop{std::vector<double>(room), std::vector<double>(room), std::vector<std::int32_t>(room)};
    use_whole(hooks, hbvib_branch_contact_loop_with_hooks, point, contact, direction, n, loop.motion.data(), loop.force.data(),
              loop.state.data());
    return loop;
  }
  /// Response to the forces of a model, from this nonlinear mode.
  Synthesis synthesis(const Model& model, const SynthesisOptions& options = SynthesisOptions(),
                      const Hooks& hooks = {}) const;
  /// Its resonances.
  std::vector<SynthesisPeak> synthesis_peaks(const Model& model, const SynthesisOptions& options = SynthesisOptions(),
                      const Hooks& hooks = {}) const;
  /// A run-up through the resonance of this nonlinear mode.
  RunUp run_up(const Model& model, const RunUpOptions& options, const Hooks& hooks = {}) const;
  /// This nonlinear mode over a mission.
  Mission mission(const Model& model, const MissionOptions& options, const Hooks& hooks = {}) const;
  /// The highest resonance of this nonlinear mode where an engine order meets it, under each factor on the forces.
  CampbellResponse campbell_response(const Model& model, const CampbellOptions& options = CampbellOptions(),
                                     In<double> force_factors = {}, const Hooks& hooks = {}) const;

 private:
  friend class Model;
  friend class Batch;
  using Object::Object;

  template <class Struct, class F, class... A>
  Struct filled(F function, A... arguments) const {
    Struct s;
    use(function, arguments..., &s);
    return s;
  }
  template <class F>
  std::vector<Peak> extremes(F function) const {
    Index count = 0;
    use(function, 0, nullptr, nullptr, nullptr, &count);
    std::vector<double> omega(detail::extent(count)), amplitude(omega.size());
    std::vector<Index> point(omega.size());
    use(function, count, omega.data(), amplitude.data(), point.data(), &count);
    std::vector<Peak> all;
    for (std::size_t i = 0; i < point.size(); i++) all.push_back({omega[i], amplitude[i], point[i]});
    return all;
  }
};

/// Highest peak of a design; NaN where the amplitude has no maximum within the range, or the design failed.
struct DesignPeak {
  double amplitude, omega;
  hbvib_status status;
  Index points;
};

/// The peaks of many designs, in the order of their values.
class Batch : public detail::Object<hbvib_batch, hbvib_batch_free> {
 public:
  Index designs() const { return use(hbvib_batch_designs); }
  std::vector<DesignPeak> peaks() const {
    const Index n = designs();
    std::vector<double> amplitude(detail::extent(n)), omega(amplitude.size());
    std::vector<std::int64_t> status(amplitude.size()), points(amplitude.size());
    use(hbvib_batch_peaks, n, amplitude.data(), omega.data(), status.data(), points.data());
    std::vector<DesignPeak> all;
    for (std::size_t i = 0; i < amplitude.size(); i++)
      all.push_back({amplitude[i], omega[i], static_cast<hbvib_status>(status[i]), points[i]});
    return all;
  }
  /// The sentence of a design whose status is not HBVIB_OK; empty for HBVIB_OK.
  std::string sentence(Index design) const { return static_cast<void>(hbvib_batch_status(get(), design)), last_error(); }
  /// The branch of a design, which leaves the batch; options.keep must have been 1.
  Branch take_branch(Index design) {
    const auto keep = core_;
    auto core = std::make_shared<Branch::Core>();
    core->forces = core_->forces;
    detail::call(hbvib_batch_branch, get(), design, &core->handle);
    return Branch(std::move(core));
  }

 private:
  friend class Model;
  using Object::Object;
};

/// A structure with its contacts and forces. Solving is const: any number of threads may solve one model.
class Model : public detail::Object<hbvib_model, hbvib_model_free> {
 public:
  /// A plain structure of so many degrees of freedom: no matrices, contacts or forces yet.
  static Model plain(Index ndof) { return make(hbvib_model_new, ndof); }
  /// A cyclic structure of equal sectors, described by one of them.
  static Model cyclic(Index ndof_sector, Index sectors) { return make(hbvib_cyclic_new, ndof_sector, sectors); }
  /// A cyclic structure from one sector with degrees of freedom on both faces.
  static Model sector(const Sector& description) { return make(hbvib_cyclic_from_sector, &description); }
  Model clone() const {
    Model copy = make(hbvib_model_clone, get());
    copy.core_->forces = core_->forces;
    return copy;
  }
  /// A copy for motions with some periods of the forces, as those of a child whose descent().periods is above 1.
  Model longer_period(Index periods) const {
    Model copy = make(hbvib_model_longer_period, get(), periods);
    copy.core_->forces = core_->forces;
    return copy;
  }

  /// The model as bytes, for load in any process. Error (HBVIB_E_UNSUPPORTED) for a model with a user force.
  std::vector<unsigned char> save() const {
    Index size = 0;
    use(hbvib_model_save, 0, nullptr, &size);
    std::vector<unsigned char> bytes(detail::extent(size));
    use(hbvib_model_save, size, bytes.data(), &size);
    return bytes;
  }
  /// The model that save made bytes of.
  static Model load(In<unsigned char> bytes) { return make(hbvib_model_load, bytes.length(), bytes.data()); }

  Index dofs() const { return use(hbvib_model_dofs); }
  Index sectors() const { return use(hbvib_model_sectors); }
  Index contacts() const { return use(hbvib_model_contacts); }

  void set_matrix(hbvib_matrix_kind which, const Matrix& a) { use(hbvib_model_set_matrix, which, &a); }
  /// Fixes degrees of freedom, now or before matrices are set; their numbers stay.
  void fix(In<Index> dofs) { use(hbvib_model_fix, dofs.length(), dofs.data()); }
  void set_rayleigh(double alpha_mass, double beta_stiffness) { use(hbvib_model_set_rayleigh, alpha_mass, beta_stiffness); }
  /// Structural damping i loss_factor K of the structure's own stiffness in harmonics above 0.
  void set_loss_factor(double loss_factor) { use(hbvib_model_set_loss_factor, loss_factor); }
  /// Damping ratios of the lowest natural modes without contacts; {}: none.
  void set_modal_damping(In<double> ratios) { use(hbvib_model_set_modal_damping, ratios.length(), ratios.data()); }
  /// A fixed speed of rotation.
  void set_speed(double speed) { use(hbvib_model_set_speed, speed); }
  /// Omega = per_omega omega along a sweep; 1 / EO for an excitation of engine order EO.
  void set_speed_per_omega(double per_omega) { use(hbvib_model_set_speed_per_omega, per_omega); }
  void set_coupling(hbvib_matrix_kind which, const Matrix& to_next) { use(hbvib_cyclic_set_coupling, which, &to_next); }
  void set_coupling_previous(hbvib_matrix_kind which, const Matrix& to_previous) {
    use(hbvib_cyclic_set_coupling_previous, which, &to_previous);
  }
  void set_diameter(hbvib_matrix_kind which, Index diameter, const Matrix& a) { use(hbvib_cyclic_set_diameter, which, diameter, &a); }
  void set_wave(Index engine_order) { use(hbvib_cyclic_set_wave, engine_order); }
  /// Aerodynamic forces: for each offset a square matrix over `dofs`, row after row; {} removes those of this form.
  void set_aero(In<Index> dofs, In<Complex> coefficients, In<Index> offsets, hbvib_aero_form form) {
    const Index n = dofs.length();
    if (coefficients.length() != n * n * offsets.length())
      throw Error(HBVIB_E_DIMENSION, 5, std::to_string(coefficients.length()) + " coefficients, needs offsets x dofs x dofs");
    use(hbvib_cyclic_set_aero, n, dofs.data(), offsets.length(), reinterpret_cast<const double*>(coefficients.data()), offsets.data(), form);
  }

  /// The whole wheel of a cyclic model, a plain model: degree of freedom i of sector s is s * ndof + i.
  Model wheel() const {
    Model whole = make(hbvib_wheel_new, get());
    whole.core_->forces = core_->forces;
    return whole;
  }
  /// Mistunes the wheel of a sector by a number for each; dofs of the blade, contact -1: all with a normal load.
  void mistune(const Model& sector, hbvib_mistuning kind, In<double> delta, In<Index> dofs = {}, Index contact = -1) {
    use(hbvib_wheel_mistune, sector.get(), kind, dofs.length(), dofs.data(), nullptr, contact, delta.length(), delta.data());
  }
  /// The pattern of a wheel of this sector from measured modes: their angular frequencies, and shapes of all sectors at the points,
  /// mode after mode, sector after sector, with standard deviations. `families` tuned modes of each nodal diameter are the basis.
  IdentifiedPattern identify_pattern(hbvib_mistuning kind, In<Index> blade, hbvib_contact_state contacts, Index families, In<Index> points,
                                     In<double> omega, In<double> sigma_omega, In<Complex> shapes, In<double> sigma_shape) const {
    const Index n = sectors(), modes = omega.length();
    if (sigma_omega.length() != modes || sigma_shape.length() != modes || shapes.length() != modes * n * points.length())
      throw Error(HBVIB_E_DIMENSION, 13, std::to_string(shapes.length()) + " numbers of shapes, needs modes x sectors x points; one sigma a mode");
    IdentifiedPattern found{std::vector<double>(detail::room(n)), std::vector<double>(detail::room(n, n)), 0, 0};
    use(hbvib_wheel_identify, kind, blade.length(), blade.data(), nullptr, contacts, families, points.length(), points.data(), modes,
        omega.data(), sigma_omega.data(), reinterpret_cast<const double*>(shapes.data()), sigma_shape.data(), nullptr, n,
        found.delta.data(), found.covariance.data(), &found.chi2, &found.degrees);
    return found;
  }

  /// Adds Re(amplitude exp(i harmonic omega t)) on a degree of freedom.
  void add_force(Index dof, Index harmonic, Complex amplitude) {
    use(hbvib_model_add_force, dof, harmonic, amplitude.real(), amplitude.imag());
  }
  /// m_e omega^2 cos(omega t + phase) on dof_x and m_e omega^2 sin(omega t + phase) on dof_y.
  void add_unbalance(Index dof_x, Index dof_y, double m_e, double phase = 0) { use(hbvib_model_add_unbalance, dof_x, dof_y, m_e, phase); }
  void clear_forces() { use(hbvib_model_clear_forces); }

  // Contacts: each returns the number of the (first) contact added. Arrays that may be left out: {}.
  Index add_contact(const Contact& c) { return add(hbvib_model_add_contact, &c); }
  /// A damper under platforms: a rigid body whose motions are new degrees of freedom behind all others. Its faces are given beside it.
  DamperPlace add_damper(Damper damper, const std::vector<DamperFace>& faces) {
    const std::vector<hbvib_damper_face> given(faces.begin(), faces.end());
    damper.faces = given.data();
    damper.faces_len = static_cast<Index>(given.size());
    DamperPlace place{};
    use(hbvib_model_add_damper, &damper, &place.dof, &place.contact);
    return place;
  }
  /// preload + per_speed2 Omega^2 at the speed of rotation Omega.
  void set_preload(Index id, double preload, double per_speed2 = 0) { use(hbvib_model_set_preload_at_speed, id, preload, per_speed2); }
  /// Place of the slider of a friction contact before any motion, along t1 (direction 0) or t2 (1).
  void set_slider(Index id, double place, Index direction = 0) { use(hbvib_model_set_slider, id, direction, place); }
  Index add_jenkins(In<Index> dof_a, In<Index> dof_b, In<Index> sector_offset, In<double> kt, In<double> mu, In<double> preload) {
    const Index n = dof_a.length();
    detail::check_length(dof_b.size(), n, 4, "dof_b");
    detail::check_length(sector_offset.size(), n, 5, "sector_offset", true);
    detail::check_length(kt.size(), n, 6, "kt");
    detail::check_length(mu.size(), n, 7, "mu");
    detail::check_length(preload.size(), n, 8, "preload");
    return add(hbvib_model_add_jenkins, n, dof_a.data(), dof_b.data(), sector_offset.data(), kt.data(), mu.data(), preload.data());
  }
  /// Linear springs, which are no contacts.
  void add_springs(In<Index> dof_a, In<Index> dof_b, In<Index> sector_offset, In<double> stiffness) {
    const Index n = dof_a.length();
    detail::check_length(dof_b.size(), n, 4, "dof_b");
    detail::check_length(sector_offset.size(), n, 5, "sector_offset", true);
    detail::check_length(stiffness.size(), n, 6, "stiffness");
    use(hbvib_model_add_springs, n, dof_a.data(), dof_b.data(), sector_offset.data(), stiffness.data());
  }
  Index add_iwan(Index dof_a, Index dof_b, Index sector_offset, double slip_force, double stiffness, double chi, double beta, Index elements) {
    return add(hbvib_model_add_iwan, dof_a, dof_b, sector_offset, slip_force, stiffness, chi, beta, elements);
  }
  /// f(y) straight between points.
  Index add_table(Index dof_a, Index dof_b, Index sector_offset, In<double> displacement, In<double> force) {
    detail::check_length(force.size(), displacement.length(), 7, "force");
    return add(hbvib_model_add_table, dof_a, dof_b, sector_offset, displacement.length(), displacement.data(), force.data());
  }
  /// Polynomials in y and in v, from the first power on.
  Index add_spring_damper(Index dof_a, Index dof_b, Index sector_offset, In<double> spring, In<double> damper = {}) {
    return add(hbvib_model_add_spring_damper, dof_a, dof_b, sector_offset, spring.length(), spring.data(), damper.length(), damper.data());
  }
  /// Terms over several degrees of freedom; exponents terms x dofs, {}: all 0.
  Index add_polynomial(In<Index> dofs, In<Index> direction, In<double> coefficient, In<std::int32_t> x_powers, In<std::int32_t> v_powers = {}) {
    const Index n = dofs.length(), terms = direction.length(), exponents = static_cast<Index>(detail::extent(n, terms));
    detail::check_length(coefficient.size(), terms, 6, "coefficient");
    detail::check_length(x_powers.size(), exponents, 7, "x_powers", true);
    detail::check_length(v_powers.size(), exponents, 8, "v_powers", true);
    return add(hbvib_model_add_polynomial, dofs.data(), n, terms, direction.data(), coefficient.data(), x_powers.data(), v_powers.data());
  }
  /// Quadratic (n^3) and cubic (n^4) stiffness, the last index running fastest; {}: none.
  Index add_stiffness_tensors(In<Index> dofs, In<double> quadratic, In<double> cubic) {
    const Index n = dofs.length(), square = static_cast<Index>(detail::extent(n, n));
    detail::check_length(quadratic.size(), static_cast<Index>(detail::extent(square, n)), 4, "quadratic", true);
    detail::check_length(cubic.size(), static_cast<Index>(detail::extent(square, square)), 5, "cubic", true);
    return add(hbvib_model_add_stiffness_tensors, dofs.data(), n, quadratic.data(), cubic.data());
  }
  /// Node pairs of two surfaces, one for each area; three degrees of freedom and directions a pair.
  /// dof_b {}: the ground. pressure, gap {}: those of the law.
  Index add_patch(const Contact& law, In<Index> dof_a, In<Index> dof_b, In<double> normal, In<double> tangent, In<double> area,
                  In<double> pressure = {}, In<double> gap = {}) {
    const Index n = area.length();
    detail::check_length(dof_a.size(), 3 * n, 4, "dof_a");
    detail::check_length(dof_b.size(), 3 * n, 5, "dof_b", true);
    detail::check_length(normal.size(), 3 * n, 6, "normal");
    detail::check_length(tangent.size(), 3 * n, 7, "tangent", true);
    detail::check_length(pressure.size(), n, 9, "pressure", true);
    detail::check_length(gap.size(), n, 10, "gap", true);
    return add(hbvib_model_add_patch, &law, n, dof_a.data(), dof_b.data(), normal.data(), tangent.data(), area.data(), pressure.data(), gap.data());
  }
  /// A force of the caller. The model, its clones and the branches solved from them share it.
  Index add_user_force(UserForce force) {
    const auto shared = std::make_shared<const UserForce>(std::move(force));
    Filled<hbvib_user_force, hbvib_user_force_init> c;
    c.uses_velocity = shared->uses_velocity;
    c.is_odd = shared->is_odd;
    c.dofs = shared->dofs.data();
    c.n = static_cast<Index>(shared->dofs.size());
    c.states = shared->states;
    c.samples = shared->samples;
    c.force = shared->force ? detail::on_force : nullptr;
    c.user = const_cast<UserForce*>(shared.get());
    if (core_) core_->forces.reserve(core_->forces.size() + 1);  // so that nothing fails once it is in the model
    const Index id = add(hbvib_model_add_user_force, &c);
    core_->forces.push_back(shared);
    return id;
  }
  /// The worst derivative that a force of the caller writes.
  JacobianGap check_jacobian(Index contact, double omega, In<double> amplitude) const {
    JacobianGap gap;
    use(hbvib_check_jacobian, contact, omega, amplitude.data(), amplitude.length(), &gap);
    return gap;
  }

  /// A stop by the hooks is Error (HBVIB_STOPPED_BY_CALLER), as in all functions that return no branch.
  LinearModes linear_modes(Index diameter, hbvib_contact_state contacts, Index count, const Hooks& hooks = {}) const {
    const Index n = dofs();
    LinearModes modes{std::vector<double>(detail::room(count)), {}};
    const detail::Array<Complex> shapes(detail::room(count, n));
    use_whole(hooks, hbvib_linear_modes_with_hooks, diameter, contacts, count, modes.omega.data(), detail::flat(shapes.data()));
    modes.shapes = shapes.view({count, n});
    return modes;
  }
  /// Damped natural modes at the speed of the model, by rising frequency.
  DampedModes damped_modes(Index diameter, hbvib_contact_state contacts, Index count) const {
    const Index n = dofs();
    DampedModes modes{std::vector<Complex>(detail::room(count)), {}, std::vector<Index>(detail::room(count))};
    const detail::Array<Complex> shapes(detail::room(count, n));
    use(hbvib_damped_modes, diameter, contacts, count, detail::flat(modes.eigenvalue.data()), detail::flat(shapes.data()), modes.direction.data(),
        nullptr);
    modes.shapes = shapes.view({count, n});
    return modes;
  }
  /// Damped modes of a signed nodal diameter at rising speeds, and where engine orders meet those of the sense that they excite.
  Campbell campbell(In<double> speeds, Index diameter, hbvib_contact_state contacts, Index count, In<Index> engine_orders) const {
    const Index n = speeds.length(), room = n * count;
    Campbell c{count, std::vector<double>(detail::room(room)), std::vector<double>(detail::room(room)), std::vector<Index>(detail::room(room)), {}};
    use(hbvib_campbell, n, speeds.data(), diameter, contacts, count, c.omega.data(), c.damping_ratio.data(), c.direction.data(), nullptr);
    std::vector<double> at(detail::room(room)), omega(at.size());
    std::vector<Index> sense(at.size());
    for (Index k = 0; k < engine_orders.length(); k++) {
      Index found = 0;
      const Index order = engine_orders.data()[k];
      use(hbvib_campbell_crossings, n, speeds.data(), diameter, contacts, count, order, room, at.data(), omega.data(), sense.data(), &found, nullptr);
      const Index wave = signed_diameter(order);
      for (std::size_t i = 0; i < detail::extent(found); i++) c.crossings.push_back({order, at[i], omega[i], sense[i], wave});
    }
    return c;
  }
  /// Damped modes of all waves of a wheel, in both senses of each nodal diameter, at the speed of the model.
  Interference interference(hbvib_contact_state contacts, Index count) const {
    const Index waves = sectors(), room = waves * count;
    Interference all{count, std::vector<Index>(detail::room(waves)), std::vector<double>(detail::room(room)),
                     std::vector<double>(detail::room(room)), std::vector<Index>(detail::room(room)), false};
    Index equal = 0;
    use(hbvib_interference, contacts, count, waves, all.diameters.data(), all.omega.data(), all.damping_ratio.data(), all.direction.data(), &equal,
        nullptr);
    all.equal_senses = equal != 0;
    return all;
  }
  /// The signed nodal diameter of a number of waves per turn, or of the wave that an engine order excites.
  Index signed_diameter(Index waves) const {
    Index diameter = 0;
    return use(hbvib_cyclic_signed_diameter, waves, &diameter), diameter;
  }
  /// A contact, read back. Its kind may be HBVIB_TABLE, HBVIB_POLYNOMIAL or HBVIB_CALLER_LAW, which have no constants.
  Contact contact(Index id) const {
    Contact c;
    return use(hbvib_model_contact, id, &c, nullptr), c;
  }
  /// A coefficient of aerodynamic forces, read back; the offset counts from the sector of the force to that of the motion.
  struct AeroEntry {
    Index dof_force;
    Index dof_motion;
    Index offset;
    Complex coefficient;
  };
  /// The aerodynamic forces of a form, in the order in which they were given.
  std::vector<AeroEntry> aero(hbvib_aero_form form) const {
    Index n = 0;
    use(hbvib_cyclic_aero, form, 0, nullptr, nullptr, nullptr, nullptr, &n);
    std::vector<Index> force(detail::extent(n)), motion(force), offset(force);
    std::vector<Complex> coefficient(force.size());
    use(hbvib_cyclic_aero, form, n, force.data(), motion.data(), offset.data(), reinterpret_cast<double*>(coefficient.data()), &n);
    std::vector<AeroEntry> entries;
    for (std::size_t i = 0; i < force.size(); i++) entries.push_back({force[i], motion[i], offset[i], coefficient[i]});
    return entries;
  }
  /// A force, read back; over the square of the angular frequency if it is that of an unbalance.
  struct Force {
    Index dof, harmonic;
    Complex value;
    bool unbalance;
  };
  /// The forces in the order in which they were added.
  std::vector<Force> forces() const {
    Index count = 0;
    use(hbvib_model_forces, Index(0), nullptr, nullptr, nullptr, nullptr, &count);
    const std::size_t n = detail::extent(count);
    std::vector<Index> dof(n), harmonic(n), unbalance(n);
    std::vector<Complex> value(n);
    use(hbvib_model_forces, count, dof.data(), harmonic.data(), detail::flat(value.data()), unbalance.data(), &count);
    std::vector<Force> all;
    for (std::size_t i = 0; i < n; i++) all.push_back({dof[i], harmonic[i], value[i], unbalance[i] != 0});
    return all;
  }
  /// A matrix or a block of it, read back: ndof x ndof, without Rayleigh damping, springs and contacts.
  View<const Complex> matrix(hbvib_matrix_kind which, hbvib_block block = HBVIB_BLOCK_OWN) const {
    Index count = 0;
    use(hbvib_model_matrix, which, block, Index(0), nullptr, nullptr, nullptr, &count);
    const std::size_t n = detail::extent(count);
    std::vector<Index> row(n), column(n);
    std::vector<Complex> value(n);
    use(hbvib_model_matrix, which, block, count, row.data(), column.data(), detail::flat(value.data()), &count);
    const Index order = dofs();
    const detail::Array<Complex> a(detail::extent(order, order));
    for (std::size_t k = 0; k < n; k++) a.data()[row[k] * order + column[k]] = value[k];
    return a.view({order, order});
  }
  /// The response to the forces over a range of frequency.
  [[nodiscard]] Branch forced_response(const SolverOptions& solver, const ForcedOptions& range, const Hooks& hooks = {}) const {
    return solve(hbvib_forced_response, solver, range, hooks);
  }
  /// The forced response over a parameter, at a fixed frequency or in a peak; solver.tolerance must be 0.
  Branch parameter_response(const SolverOptions& solver, const ParameterOptions& range, const Hooks& hooks = {}) const {
    return solve(hbvib_parameter_response, solver, range, hooks);
  }
  /// A nonlinear mode over a range of amplitude.
  [[nodiscard]] Branch nonlinear_mode(const SolverOptions& solver, const ModeOptions& range, const Hooks& hooks = {}) const {
    return solve(hbvib_nonlinear_mode, solver, range, hooks);
  }
  /// Residual of harmonic balance at x, (H + 1) x ndof, with its derivatives if requested.
  Residual forced_residual(const SolverOptions& solver, double omega, In<Complex> x, bool derivatives = false,
                           const Hooks& hooks = {}) const {
    const Index n = x.length(), order = 2 * n;
    Residual out{std::vector<Complex>(detail::room(n)), {}, std::vector<Complex>(derivatives ? detail::room(n) : 0)};
    double* const d_omega = derivatives ? detail::flat(out.d_omega.data()) : nullptr;
    const detail::Array<double> jacobian(derivatives ? detail::extent(order, order) : 0);
    use_whole(hooks, hbvib_forced_residual_with_hooks, &solver, omega, detail::flat(x.data()), n, detail::flat(out.r.data()), n, jacobian.data(),
        jacobian.length(), d_omega, derivatives ? n : 0);
    if (derivatives) out.jacobian = {jacobian.data(), 2, {order, order, 1}, {1, order, 1}, jacobian.numbers};
    return out;
  }
  /// The periodic response at one frequency by integration in time. hooks.partial plays no part.
  TimeResponse time_response(const TimeOptions& options, const Hooks& hooks = {}) const {
    const Index n = dofs(), rows = options.harmonics < 0 ? 0 : options.harmonics + 1;
    const detail::Array<Complex> x(detail::extent(rows, n));
    const detail::Array<double> samples(detail::extent(options.samples, n));
    const detail::BoundHooks bound(hooks);
    TimeResponse out{};
    out.status = use(hbvib_time_response, &options, &bound, detail::flat(x.data()), x.length(),
                     samples.data(), samples.length(), &out.info);
    out.harmonics = x.view({rows, n});
    out.samples = samples.view({options.samples, n});
    return out;
  }
  /// How far a point of a forced response is from the motion that integration in time finds from it. hooks.partial
  /// plays no part.
  Verification verify(const Branch& branch, Index point, const VerifyOptions& options = VerifyOptions(), const Hooks& hooks = {}) const {
    const auto keep = branch.core_;
    const Index rows = branch.reduction().harmonics_asked + 1, n = dofs();
    const detail::Array<Complex> x(detail::extent(rows, n));
    const detail::BoundHooks bound(hooks);
    Verification out{};
    out.errors.resize(detail::extent(rows));
    out.status = use(hbvib_verify, branch.get(), point, &options, &bound, detail::flat(x.data()), x.length(), out.errors.data(), rows,
                     &out.info);
    out.harmonics = x.view({rows, n});
    return out;
  }
  /// Exact derivatives of a result at a point by parameters, from one adjoint solution. A hook that stops it is an Error.
  Sensitivities sensitivity(const Branch& branch, Index point, const std::vector<Parameter>& parameters,
                            hbvib_quantity of = HBVIB_OF_AMPLITUDE, const Hooks& hooks = {}) const {
    const auto keep = branch.core_;
    const std::vector<hbvib_parameter> given(parameters.begin(), parameters.end());
    Sensitivities out{std::vector<double>(given.size()), {}, -1};
    std::vector<std::int64_t> reasons(given.size());
    const auto count = static_cast<Index>(given.size());
    use_whole(hooks, hbvib_sensitivity, branch.get(), point, of, given.data(), count, out.derivatives.data(), count, reasons.data(), &out.onset);
    for (const auto reason : reasons) out.reasons.push_back(static_cast<hbvib_derivative>(reason));
    return out;
  }
  /// Exact derivatives of the complex amplitude of a degree of freedom at a point of a forced response. A hook that stops it is an Error.
  ComplexSensitivities response_sensitivity(const Branch& branch, Index point, const std::vector<Parameter>& parameters, Index dof,
                                            const Hooks& hooks = {}) const {
    const auto keep = branch.core_;
    const std::vector<hbvib_parameter> given(parameters.begin(), parameters.end());
    const auto count = static_cast<Index>(given.size());
    const std::int64_t of = dof;
    Filled<hbvib_response, hbvib_response_init> response;
    response.n = 1, response.dofs = &of;
    ComplexSensitivities out{{}, {}, std::vector<Complex>(given.size()), {}, -1};
    std::vector<std::int64_t> reasons(given.size());
    use_whole(hooks, hbvib_response_sensitivity, branch.get(), point, static_cast<const hbvib_response*>(&response), given.data(), count,
              detail::flat(out.derivatives.data()), count, reasons.data(), &out.onset, detail::flat(&out.value), detail::flat(&out.by_omega));
    for (const auto reason : reasons) out.reasons.push_back(static_cast<hbvib_derivative>(reason));
    return out;
  }
  /// Fits parameters to data of tests; without unknowns all start at the values of the model. A hook that stops it is an Error.
  Fit fit(const SolverOptions& solver, const std::vector<Parameter>& parameters, const std::vector<Unknown>& unknowns,
          const std::vector<DataSet>& data, const FitOptions& options = FitOptions(), const Hooks& hooks = {}) const {
    const auto keep = core_;
    const std::vector<hbvib_parameter> given(parameters.begin(), parameters.end());
    const std::vector<hbvib_unknown> described(unknowns.begin(), unknowns.end());
    const std::vector<hbvib_data> sets(data.begin(), data.end());
    if (!described.empty() && described.size() != given.size())
      throw Error(HBVIB_E_DIMENSION, 7, "needs as many unknowns as parameters, or none");
    Index points = 0;
    for (const auto& set : sets) points += set.n;
    const std::size_t p = given.size(), numbers = 2 * detail::extent(points);
    Fit out{FitInfo(), std::vector<double>(p), std::vector<double>(p * p), std::vector<double>(numbers), std::vector<double>(numbers)};
    const detail::BoundHooks bound(hooks);
    detail::Call call;
    call.done_whole(hbvib_fit(get(), &solver, &options, &bound, given.data(), static_cast<Index>(p), described.empty() ? nullptr : described.data(),
                              sets.data(), static_cast<Index>(sets.size()), &out.info, out.theta.data(), out.covariance.data(),
                              static_cast<Index>(numbers), out.residuals.data(), out.values.data(), nullptr));
    return out;
  }
  /// Least loss over values of parameter `number`, in ascending order, all others fitted again; `info` has the interval whose ends rise
  /// by `rise` standard deviations squared, 3.841 for 95 %.
  FitProfile fit_profile(const SolverOptions& solver, const std::vector<Parameter>& parameters, const std::vector<Unknown>& unknowns,
                         const std::vector<DataSet>& data, Span<const double> theta, Index number, Span<const double> values, double rise = 3.841,
                         const FitOptions& options = FitOptions(), const Hooks& hooks = {}) const {
    const auto keep = core_;
    const std::vector<hbvib_parameter> given(parameters.begin(), parameters.end());
    const std::vector<hbvib_unknown> described(unknowns.begin(), unknowns.end());
    const std::vector<hbvib_data> sets(data.begin(), data.end());
    if (!described.empty() && described.size() != given.size())
      throw Error(HBVIB_E_DIMENSION, 7, "needs as many unknowns as parameters, or none");
    const auto p = static_cast<Index>(given.size());
    if (theta.length() != p) throw Error(HBVIB_E_DIMENSION, 10, "needs as many numbers as parameters");
    const std::size_t n = detail::extent(values.length());
    FitProfile out{FitProfileInfo(), std::vector<double>(n), std::vector<double>(n * given.size()), false};
    const detail::BoundHooks bound(hooks);
    detail::Call call;
    const auto status = hbvib_fit_profile(get(), &solver, &options, &bound, given.data(), p, described.empty() ? nullptr : described.data(),
                                          sets.data(), static_cast<Index>(sets.size()), theta.data(), number, values.length(), values.data(),
                                          rise, &out.info, out.loss.data(), out.theta.data());
    call.done(status);
    out.stopped = status == HBVIB_STOPPED_BY_CALLER;
    return out;
  }
  /// Predicts the numbers of a data set without values at fitted values of parameters with their covariance, row after row.
  Predicted predict(const SolverOptions& solver, const DataSet& wanted, const std::vector<Parameter>& parameters, Span<const double> theta,
                    Span<const double> covariance, const Hooks& hooks = {}) const {
    const auto keep = core_;
    const std::vector<hbvib_parameter> given(parameters.begin(), parameters.end());
    const auto p = static_cast<Index>(given.size());
    if (theta.length() != p || covariance.length() != p * p)
      throw Error(HBVIB_E_DIMENSION, 7, "needs as many numbers as parameters, and its square");
    const std::size_t n = 2 * detail::extent(wanted.n);
    Predicted out{std::vector<double>(n), std::vector<double>(n), std::vector<double>(n)};
    const detail::BoundHooks bound(hooks);
    detail::Call call;
    call.done_whole(hbvib_predict(get(), &solver, &wanted, &bound, given.data(), p, theta.data(), covariance.data(), static_cast<Index>(n),
                                  out.values.data(), out.sigma.data(), out.shift.data()));
    return out;
  }
  /// The motion in time while the frequency of the forces changes at a constant rate.
  TimeSweep time_sweep(const SweepOptions& options, const Hooks& hooks = {}) const {
    const auto keep = core_;
    const double square = options.omega_stop * options.omega_stop - options.omega_start * options.omega_start;
    const double turns = options.rate > 0 ? std::abs(square) / (12.566370614359172 * options.rate) : 0;
    Index count = turns < 1e8 ? static_cast<Index>(turns) + 2 : 2;
    const std::size_t n = detail::extent(count);
    TimeSweep out{std::vector<double>(n), std::vector<double>(n), std::vector<double>(n), SweepInfo(), false};
    const detail::BoundHooks bound(hooks);
    detail::Call call;
    const auto status = hbvib_time_sweep(get(), &options, &bound, count, out.time.data(), out.omega.data(), out.amplitude.data(), &count,
                                         &out.info);
    call.done(status);
    out.stopped = status == HBVIB_STOPPED_BY_CALLER;
    for (auto* list : {&out.time, &out.omega, &out.amplitude}) list->resize(detail::extent(count));
    return out;
  }
  /// Wear over a life: states at the wanted cycles, in ascending order.
  Life life(const LifeOptions& options, In<double> cycles, const SolverOptions& solver = SolverOptions(), const Hooks& hooks = {}) const {
    const auto keep = core_;
    const std::size_t n = detail::extent(cycles.length()), all = n * detail::extent(options.contacts_len);
    Life out{options.contacts_len, std::vector<double>(all), std::vector<double>(all), std::vector<double>(all), std::vector<double>(n),
             std::vector<double>(n), {}, LifeInfo(), HBVIB_OK};
    constexpr Index room = 1024;
    std::vector<double> at(detail::extent(room));
    std::vector<Index> kind(detail::extent(room)), contact(detail::extent(room));
    Index events = 0;
    const detail::BoundHooks bound(hooks);
    detail::Call call;
    out.status = hbvib_life(get(), &solver, &options, &bound, cycles.length(), cycles.data(), out.depths.data(), out.loads.data(),
                            out.works.data(), out.amplitude.data(), out.omega.data(), room, at.data(), kind.data(), contact.data(), &events,
                            &out.info);
    call.done(out.status);
    for (std::size_t i = 0; i < detail::extent(events < room ? events : room); i++) out.events.push_back({at[i], kind[i], contact[i]});
    return out;
  }
  /// The factor on the loads of the contacts that wear, between two, with which the largest amplitude over a life is least.
  BestLoad best_load_for_life(const LifeOptions& options, double cycles, double factor_low, double factor_high,
                              const SolverOptions& solver = SolverOptions(), const Hooks& hooks = {}) const {
    const auto keep = core_;
    BestLoad out;
    const detail::BoundHooks bound(hooks);
    detail::Call call;
    call.done_whole(hbvib_best_load_for_life(get(), &solver, &options, cycles, factor_low, factor_high, &bound, &out));
    return out;
  }
  /// The sliders of a point of a forced response that stick through the period and change its vibration. A hook that stops it is
  /// an Error.
  std::vector<FreeSlider> freedom(const Branch& branch, Index point, const Hooks& hooks = {}) const {
    const auto keep = branch.core_;
    const std::size_t room = detail::extent(2 * branch.reduction().contacts);
    std::vector<Index> contact(room), direction(room);
    std::vector<double> place(room), derivative(room);
    Index count = 0;
    use_whole(hooks, hbvib_branch_freedom, branch.get(), point, static_cast<Index>(room), contact.data(), direction.data(),
                   place.data(), derivative.data(), &count);
    std::vector<FreeSlider> out;
    for (std::size_t i = 0; i < detail::extent(count); i++) out.push_back({contact[i], direction[i], place[i], derivative[i]});
    return out;
  }
  /// Static states along a load history with friction: factors of the constant forces, speeds, or as many of both, one for each step. The
  /// places of a step are the residual state that is left there, for set_slider. A hook that stops it is an Error.
  StaticHistory static_history(const std::vector<double>& factors, const std::vector<double>& speeds = {},
                               const SolverOptions& solver = SolverOptions(), const Hooks& hooks = {}) const {
    const auto keep = core_;
    if (!factors.empty() && !speeds.empty() && factors.size() != speeds.size())
      throw Error(HBVIB_E_DIMENSION, 4, "needs as many speeds as factors, or none of one");
    const std::size_t steps = factors.empty() ? speeds.size() : factors.size();
    const std::size_t count = detail::extent(contacts());
    StaticHistory out{static_cast<Index>(steps), std::vector<double>(steps * detail::extent(dofs())),
                      std::vector<double>(steps * count * 2), std::vector<double>(steps * count * 3)};
    const detail::BoundHooks bound(hooks);
    detail::Call call;
    call.done_whole(hbvib_static_history(get(), &solver, out.steps, factors.empty() ? nullptr : factors.data(),
                                         speeds.empty() ? nullptr : speeds.data(), &bound, out.motion.data(),
                                         static_cast<Index>(out.motion.size()), out.places.data(), static_cast<Index>(out.places.size()),
                                         out.forces.data(), static_cast<Index>(out.forces.size())));
    return out;
  }
  /// The least and the largest result at a point of a forced response over all residual forces of contacts that stick. A hook that
  /// stops it is an Error.
  Band band(const Branch& branch, Index point, const BandOptions& options = BandOptions(), const Hooks& hooks = {}) const {
    const auto keep = core_;
    const auto kept = branch.core_;
    const std::size_t room = detail::extent(2 * branch.reduction().contacts);
    Band out{BandInfo(), std::vector<Index>(room), std::vector<Index>(room), std::vector<double>(room), std::vector<double>(room)};
    const detail::BoundHooks bound(hooks);
    detail::Call call;
    call.done_whole(hbvib_band(get(), branch.get(), point, nullptr, &options, &bound, &out.info, static_cast<Index>(room),
                               out.contact.data(), out.direction.data(), out.lower_place.data(), out.upper_place.data(), 0, nullptr,
                               nullptr, nullptr));
    const std::size_t n = detail::extent(out.info.sliders);
    out.contact.resize(n), out.direction.resize(n), out.lower_place.resize(n), out.upper_place.resize(n);
    return out;
  }
  /// The lower and the upper curve of a forced response over its residual forces, at all points of the curve or at some.
  BandCurve band_curve(const Branch& branch, In<Index> points = {}, const BandOptions& options = BandOptions(), const Hooks& hooks = {}) const {
    const auto keep = core_;
    const auto kept = branch.core_;
    const Index count = points.length() > 0 ? points.length() : branch.points();
    const std::size_t n = detail::extent(count);
    BandCurve out{std::vector<double>(n), std::vector<double>(n), std::vector<double>(n), std::vector<Index>(n), std::vector<Index>(n)};
    const detail::BoundHooks bound(hooks);
    detail::Call call;
    Index found = 0;
    call.done_whole(hbvib_band_curve(get(), branch.get(), points.length(), points.data(), nullptr, &options, &bound, count, out.omega.data(),
                                     out.lower.data(), out.upper.data(), out.sliders.data(), out.complete.data(), &found));
    return out;
  }
  /// The least and the largest damping ratio or frequency of a point of a nonlinear mode over all residual forces of contacts that stick,
  /// or of some.
  ModeBand mode_band(const Branch& branch, Index point, hbvib_mode_band_of of = HBVIB_MODE_BAND_DAMPING, In<Index> contacts = {},
                     const Hooks& hooks = {}) const {
    const auto keep = core_;
    const auto kept = branch.core_;
    const std::size_t room = detail::extent(2 * branch.reduction().contacts);
    ModeBand out{BandInfo(), std::vector<Index>(room), std::vector<Index>(room), {}, {}};
    std::vector<double> ends(2 * (room + 2));
    const detail::BoundHooks bound(hooks);
    detail::Call call;
    call.done_whole(hbvib_mode_band(get(), branch.get(), point, nullptr, nullptr, of, contacts.length(), contacts.data(), &bound, &out.info,
                                    static_cast<Index>(room), out.contact.data(), out.direction.data(), ends.data(), 0, nullptr));
    const std::size_t n = detail::extent(out.info.sliders);
    out.contact.resize(n), out.direction.resize(n);
    for (std::size_t i = 0; i < n; i++) out.lower_place.push_back(ends[i]), out.upper_place.push_back(ends[room + 2 + i]);
    return out;
  }
  /// The highest peak of each design: values of the parameters, design after design. A stop by a hook keeps the designs
  /// that were solved. hooks.partial plays no part.
  Batch batch(const SolverOptions& solver, const BatchOptions& options, const std::vector<Parameter>& parameters, In<double> values,
              const Hooks& hooks = {}) const {
    const auto keep = core_;
    const std::vector<hbvib_parameter> given(parameters.begin(), parameters.end());
    const auto count = static_cast<Index>(given.size());
    if (count == 0 || values.length() % count != 0)
      throw Error(HBVIB_E_DIMENSION, 8, "the number of values is no multiple of that of the parameters");
    const detail::BoundHooks bound(hooks);
    auto core = std::make_shared<Batch::Core>();
    if (keep) core->forces = keep->forces;
    detail::Call call;
    call.done(hbvib_batch_solve(get(), &solver, &options, &bound, given.data(), count, values.length() / count, values.data(), &core->handle));
    return Batch(std::move(core));
  }
  /// The smallest impulse at a degree of freedom that leads from a stable point to another motion; `saddle` is an unstable point between at
  /// the same frequency. hooks.partial plays no part.
  Kick smallest_kick(const Branch& branch, Index point, const Branch& saddle_branch, Index saddle, Index dof, Index phases = 16,
                     const Hooks& hooks = {}) const {
    const auto keep = branch.core_;
    const auto other = saddle_branch.core_;
    const detail::BoundHooks bound(hooks);
    Kick out;
    use(hbvib_smallest_kick, branch.get(), point, saddle_branch.get(), saddle, dof, phases, &bound, &out);
    return out;
  }
  /// The Floquet multipliers of a point. hooks.partial plays no part.
  Floquet floquet(const Branch& branch, Index point, const FloquetOptions& options = FloquetOptions(), const Hooks& hooks = {}) const {
    const auto keep = branch.core_;
    const std::size_t most = detail::extent(sectors(), 2 * dofs() + contacts());
    Floquet out{};
    out.multipliers.resize(most);
    std::vector<std::int64_t> classes(most);
    const detail::BoundHooks bound(hooks);
    const auto room = static_cast<Index>(most);
    out.status = use(hbvib_floquet, branch.get(), point, &options, &bound, detail::flat(out.multipliers.data()), room, classes.data(), room,
                     &out.info);
    const auto count = static_cast<std::size_t>(out.info.count);
    out.multipliers.resize(count);
    for (std::size_t i = 0; i < count; i++) out.classes.push_back(static_cast<hbvib_multiplier_class>(classes[i]));
    return out;
  }

 private:
  friend class Branch;
  using Object::Object;

  template <class F, class... A>
  static Model make(F function, A... arguments) {
    auto core = std::make_shared<Core>();
    detail::call(function, arguments..., &core->handle);
    return Model(std::move(core));
  }
  template <class F, class... A>
  Index add(F function, A... arguments) {
    Index id = 0;
    use(function, arguments..., &id);
    return id;
  }
  template <class F, class Range>
  Branch solve(F function, const SolverOptions& solver, const Range& range, const Hooks& hooks) const {
    const auto keep = core_;
    const detail::BoundHooks bound(hooks);
    auto core = std::make_shared<Branch::Core>();
    if (keep) core->forces = keep->forces;
    detail::Call call;
    const hbvib_status status = function(get(), &solver, &range, &bound, &core->handle);
    if (call.threw() && hooks.partial) *hooks.partial = core->handle ? Branch(std::move(core)) : Branch();
    call.done(status);
    return Branch(std::move(core));
  }
};

inline Synthesis Branch::synthesis(const Model& model, const SynthesisOptions& options, const Hooks& hooks) const {
  const auto keep = model.core_;
  Index count = 2 * points();
  Synthesis s{std::vector<double>(detail::extent(count)), std::vector<Complex>(detail::extent(count)), std::vector<double>(detail::extent(count))};
  use_whole(hooks, hbvib_branch_synthesis_with_hooks, model.get(), &options, count, s.omega.data(), detail::flat(s.response.data()), s.modal_amplitude.data(), &count);
  s.omega.resize(detail::extent(count));
  s.response.resize(s.omega.size());
  s.modal_amplitude.resize(s.omega.size());
  return s;
}

inline std::vector<SynthesisPeak> Branch::synthesis_peaks(const Model& model, const SynthesisOptions& options,
                                                          const Hooks& hooks) const {
  const auto keep = model.core_;
  Index count = 0;
  use_whole(hooks, hbvib_branch_synthesis_peaks_with_hooks, model.get(), &options, 0, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr, &count);
  const std::size_t n = detail::extent(count);
  std::vector<double> omega(n), amplitude(n), log10_amplitude(n), damping_ratio(n), other_mode(n), error(n);
  std::vector<std::int32_t> flags(n);
  use_whole(hooks, hbvib_branch_synthesis_peaks_with_hooks, model.get(), &options, count, omega.data(), amplitude.data(), log10_amplitude.data(),
      damping_ratio.data(), other_mode.data(), error.data(), flags.data(), &count);
  std::vector<SynthesisPeak> all;
  for (std::size_t i = 0; i < n; i++)
    all.push_back({omega[i], amplitude[i], log10_amplitude[i], damping_ratio[i], other_mode[i], error[i], flags[i]});
  return all;
}

inline RunUp Branch::run_up(const Model& model, const RunUpOptions& options, const Hooks& hooks) const {
  const auto keep = model.core_;
  const double square = options.omega_stop * options.omega_stop - options.omega_start * options.omega_start;
  // Turns of the phase; rates that are refused have none.
  const double turns = options.rate > 0 ? std::abs(square) / (12.566370614359172 * options.rate) : 0;
  Index count = turns < 2e5 ? static_cast<Index>(turns) + 2 : 2;
  const std::size_t n = detail::extent(count);
  RunUp up{std::vector<double>(n), std::vector<double>(n), std::vector<double>(n), std::vector<double>(n), 0, 0, 0, 0, 0, 0, 0, 0};
  Filled<hbvib_run_up_info, hbvib_run_up_info_init> info;
  const detail::BoundHooks bound(hooks);
  detail::Call call;
  call.done_whole(hbvib_branch_run_up(get(), model.get(), &options, &bound, count, up.time.data(), up.omega.data(), up.amplitude.data(),
                                      up.modal_amplitude.data(), &count, &info));
  for (auto* list : {&up.time, &up.omega, &up.amplitude, &up.modal_amplitude}) list->resize(detail::extent(count));
  up.largest = info.largest;
  up.largest_omega = info.largest_omega;
  up.largest_time = info.largest_time;
  up.error = info.error;
  up.without_memory = info.without_memory;
  up.steady = info.steady;
  up.slow_flow = info.slow_flow;
  up.integrated = info.integrated;
  return up;
}

inline CampbellResponse Branch::campbell_response(const Model& model, const CampbellOptions& options, In<double> force_factors,
                                                  const Hooks& hooks) const {
  const auto keep = model.core_;
  const double one = 1;
  const bool given = force_factors.length() > 0;
  const Index n = given ? force_factors.length() : 1;
  const std::vector<double> room(detail::extent(n));
  CampbellResponse found{room, room, room, room, room, room};
  const detail::BoundHooks bound(hooks);
  detail::Call call;
  call.done_whole(hbvib_campbell_response(get(), model.get(), &options, &bound, n, given ? force_factors.data() : &one, found.speed.data(),
                                          found.omega.data(), found.amplitude.data(), found.damping_ratio.data(), found.passed.data(),
                                          found.error.data()));
  return found;
}

inline Mission Branch::mission(const Model& model, const MissionOptions& options, const Hooks& hooks) const {
  const auto keep = model.core_;
  const auto room = [](Index n) { return std::vector<double>(n > 0 ? static_cast<std::size_t>(n) : 0); };
  Mission found{room(options.points_len), room(options.edges_len + 1), room(options.stresses_len), {}, 0};
  Index count = 2 * options.points_len + 16;
  std::vector<double> rows = room(6 * count);
  const detail::BoundHooks bound(hooks);
  detail::Call call;
  call.done_whole(hbvib_branch_mission(get(), model.get(), &options, &bound, found.amplitude.data(), found.cycles.data(), found.damage.data(),
                                       count, rows.data(), &count, &found.error));
  for (std::size_t i = 0; i < detail::extent(count); i++) {
    const double* row = rows.data() + 6 * i;
    found.passages.push_back({row[0], row[1], row[2], row[3], row[4], row[5]});
  }
  return found;
}

/// Force of one contact law on d prescribed motions of harmonics 0 .. H, one motion after the other.
inline ContactForce contact_evaluate(const Contact& law, Index harmonics, Index samples, double omega, In<Complex> motion,
                                     bool derivatives = false, const Hooks& hooks = {}) {
  const Index n = motion.length(), order = 2 * n;
  ContactForce out{std::vector<Complex>(detail::room(n)), {}};
  const detail::Array<double> jacobian(derivatives ? detail::extent(order, order) : 0);
  detail::call_whole(hooks, hbvib_contact_evaluate_with_hooks, &law, harmonics, samples, omega, detail::flat(motion.data()), n, detail::flat(out.force.data()), n,
               jacobian.data(), jacobian.length());
  if (derivatives) out.jacobian = {jacobian.data(), 2, {order, order, 1}, {1, order, 1}, jacobian.numbers};
  return out;
}

/// An index that counts from 1, checked against 1 .. count, as one from 0: Error (HBVIB_E_INDEX).
inline Index index_from_one(const char* name, Index index, Index count) {
  Index from_zero = 0;
  detail::call(hbvib_index_from_one, name, index, count, &from_zero);
  return from_zero;
}

/// Version of the library in use: major * 65536 + minor * 256 + patch, and as text.
inline std::uint32_t version() noexcept { return hbvib_version(); }
inline const char* version_string() noexcept { return hbvib_version_string(); }

}  // namespace hbvib

#if __cplusplus >= 202002L && defined(__cpp_lib_ranges)
// Spans and views are cheap to copy, and iterators into them stay valid without them.
template <class T>
inline constexpr bool std::ranges::enable_view<hbvib::Span<T>> = true;
template <class T>
inline constexpr bool std::ranges::enable_view<hbvib::In<T>> = true;
template <class T>
inline constexpr bool std::ranges::enable_view<hbvib::View<T>> = true;
template <class T>
inline constexpr bool std::ranges::enable_borrowed_range<hbvib::Span<T>> = true;
#endif

#endif
