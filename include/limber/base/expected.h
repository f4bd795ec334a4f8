// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_base_expected_h
#define limber_base_expected_h

/**
 * @file What the compiler cannot know of a sweep: which way conditions mostly
 * turn out. What is usual then lies in one piece, and what is rare keeps
 * nothing of it out of registers.
 */
namespace limber
{
  __attribute__((always_inline)) inline bool
  usually(const bool condition)
  {
    return __builtin_expect(condition, true);
  }



  __attribute__((always_inline)) inline bool
  rarely(const bool condition)
  {
    return __builtin_expect(condition, false);
  }
} // namespace limber

#endif
