/* RG_SANITIZED: the program was compiled with the sanitizer for addresses. GCC says so by a macro, Clang by a
 * feature. */
#ifndef RG_SANITIZED_H
#define RG_SANITIZED_H

#ifdef __has_feature
#if __has_feature(address_sanitizer)
#define RG_SANITIZED 1
#endif
#endif
#if defined __SANITIZE_ADDRESS__ && !defined RG_SANITIZED
#define RG_SANITIZED 1
#endif
#ifndef RG_SANITIZED
#define RG_SANITIZED 0
#endif

#endif
