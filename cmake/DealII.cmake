# amontons_dealii: what the few sources that include deal.II link. deal.II's own compiler flags are not taken over (they
# put -std=c++17 on the line); its debug library goes with the build type Debug.
find_package(deal.II 9.4 REQUIRED HINTS /usr/share/cmake/deal.II)
add_library(amontons_dealii INTERFACE)
target_include_directories(amontons_dealii SYSTEM INTERFACE ${DEAL_II_INCLUDE_DIRS})
target_compile_definitions(amontons_dealii INTERFACE ${DEAL_II_USER_DEFINITIONS} $<$<CONFIG:Debug>:DEBUG>)
# deal.II was built with everything, 200 libraries: only those whose symbols are used stay.
target_link_options(amontons_dealii INTERFACE -Wl,--as-needed)
target_link_libraries(amontons_dealii
                      INTERFACE "$<IF:$<CONFIG:Debug>,${DEAL_II_LIBRARIES_DEBUG},${DEAL_II_LIBRARIES_RELEASE}>")
