/// Attribute of the small functions that every mode of a standard release calls.
#pragma once

/// Inlines a function wherever it is called. As calls, these functions add a tenth to the time of a
/// standard release; where size is optimised, a call is smaller.
#if defined(__GNUC__) && !defined(__OPTIMIZE_SIZE__)
#define PINDRIVE_INLINE [[gnu::always_inline]]
#else
#define PINDRIVE_INLINE
#endif
