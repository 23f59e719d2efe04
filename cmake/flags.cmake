# Flags shared by everything of ours. Floating point is IEEE to the letter: results are the same bits for every compiler,
# SIMD width and machine, so products and sums are never contracted and no rule of arithmetic is relaxed.
add_library(lendulet_flags INTERFACE)
target_compile_options(lendulet_flags INTERFACE
    -Wall -Wextra -Wno-psabi -Wno-ignored-attributes
    -ffp-contract=off -fno-math-errno -fno-trapping-math)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # GCC 12 warns of overlaps inside std::string that cannot be (its bug 105651).
    target_compile_options(lendulet_flags INTERFACE -Wno-restrict)
elseif(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    # Masks of one lane are bools, and are combined by & as those of many lanes.
    target_compile_options(lendulet_flags INTERFACE -Wno-missing-braces -Wno-unused-const-variable
        -Wno-bitwise-instead-of-logical)
endif()
if(LENDULET_WARNINGS_ARE_ERRORS)
    target_compile_options(lendulet_flags INTERFACE -Werror)
endif()
if(LENDULET_ASSERTIONS)
    target_compile_definitions(lendulet_flags INTERFACE LENDULET_ASSERTIONS)
endif()
if(LENDULET_FOUR_LANES)
    target_compile_definitions(lendulet_flags INTERFACE LENDULET_FOUR_LANES)
endif()
if(LENDULET_EMULATED_LANES)
    target_compile_definitions(lendulet_flags INTERFACE LENDULET_EMULATED_LANES)
endif()
if(LENDULET_CERTIFICATES)
    target_compile_definitions(lendulet_flags INTERFACE LENDULET_CERTIFICATES)
endif()
if(LENDULET_SINGLE_THREADED)
    target_compile_definitions(lendulet_flags INTERFACE LENDULET_SINGLE_THREADED)
endif()
if(LENDULET_LENT_THREADS)
    target_compile_definitions(lendulet_flags INTERFACE LENDULET_LENT_THREADS)
endif()
# The core has no run-time type information, which checks of vptr need. What sanitizers insert makes GCC 12 take the
# alternatives of a variant that it does not hold for values in use.
if(LENDULET_SANITIZE)
    target_compile_options(lendulet_flags INTERFACE -Wno-maybe-uninitialized)
    target_compile_options(lendulet_flags INTERFACE -fsanitize=${LENDULET_SANITIZE} -fno-sanitize=vptr
                           -fno-omit-frame-pointer -fno-sanitize-recover=all)
    target_link_options(lendulet_flags INTERFACE -fsanitize=${LENDULET_SANITIZE})
endif()

# The core neither throws nor asks for types at run time.
add_library(lendulet_core_flags INTERFACE)
target_compile_options(lendulet_core_flags INTERFACE -fno-exceptions -fno-rtti -fvisibility=hidden)
target_link_libraries(lendulet_core_flags INTERFACE lendulet_flags)
