#pragma once
// Whether this is a sanitizers' build, where everything takes five to fifteen times as long: what
// goes the same way with less of it is done with less.

namespace mv::testing {

#ifdef MEGAVIEWS_SANITIZED
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

}  // namespace mv::testing
