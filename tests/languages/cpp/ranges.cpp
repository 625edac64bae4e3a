/* A branch, its fields and spans as ranges: range-for, algorithms, and the concepts of C++20. */
#include "common.hpp"

#include <algorithm>

#if __cplusplus >= 202002L
#include <ranges>
#include <span>
static_assert(std::ranges::random_access_range<const Branch> && std::ranges::sized_range<const Branch>);
static_assert(std::random_access_iterator<hbvib::CurveIterator>);
static_assert(std::ranges::random_access_range<hbvib::View<const double>> && std::ranges::view<hbvib::View<const double>>);
static_assert(std::ranges::contiguous_range<hbvib::Span<const double>> && std::ranges::view<hbvib::Span<const double>>);
static_assert(std::ranges::borrowed_range<hbvib::Span<double>>);
static_assert(std::is_convertible_v<hbvib::Span<const double>, std::span<const double>>);
static_assert(std::is_constructible_v<hbvib::Span<const double>, std::span<const double>&>);
#endif

int main() {
  const int wanted =
#if __cplusplus >= 202002L
      9;
#else
      6;
#endif
  return verdict(wanted, [] {
    const auto model = oscillator(1, 0.02, 1, 0.1);
    Branch branch = model.forced_response({}, ForcedOptions(0.8, 1.6));
    const auto omega = branch.field(HBVIB_OMEGA), amplitude = branch.field(HBVIB_AMPLITUDE);
    Index count = 0;
    bool same = true;
    for (const auto p : branch) same = same && p.point == count && p.omega == omega[count] && p.amplitude == amplitude[count], count++;
    claim(same && count == branch.points(), "range-for gives each point once, with its fields");
    const auto first = branch.begin();
    claim(branch.end() - first == count && (first + 3)[1].point == 4 && first < branch.end(), "iterators count");
    const auto highest = std::max_element(branch.begin(), branch.end(), [](const auto& a, const auto& b) { return a.amplitude < b.amplitude; });
    near((*highest).amplitude, *std::max_element(amplitude.begin(), amplitude.end()), 0, "algorithms take a branch");
    claim(std::none_of(branch.begin(), branch.end(), [](const auto& p) { return p.amplitude < 0; }), "and its points by value");
    const double last = omega[count - 1];
    auto place = branch.end();
    branch = Branch();
    claim((*--place).omega == last, "an iterator keeps the memory of its branch");
    refused("no branch has no points", HBVIB_E_HANDLE, 1, "", [&] { branch.begin(); });
#if __cplusplus >= 202002L
    branch = model.forced_response({}, ForcedOptions(0.8, 1.6));
    claim(std::ranges::distance(branch | std::views::filter([](const auto& p) { return p.omega >= 0.8; })) == branch.points(), "views");
    claim(std::ranges::max(branch.field(HBVIB_AMPLITUDE)) == (*highest).amplitude, "algorithms of ranges take a view");
    const std::vector<double> numbers{1, 2, 3};
    claim(std::ranges::equal(hbvib::Span<const double>(numbers), numbers), "and a span");
#endif
  });
}
