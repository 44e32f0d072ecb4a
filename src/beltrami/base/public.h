#pragma once

/// In front of the brace of a namespace: what is declared there belongs to the library's face. The rest is hidden from
/// those who link with it.
#if defined(__GNUC__)
#define BELTRAMI_PUBLIC __attribute__((visibility("default")))
#else
#define BELTRAMI_PUBLIC
#endif
