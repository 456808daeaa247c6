# Builds the page in ${WEB} and writes ${OUT}, a source file that holds it, or an empty table if ${PAGE} is off. Run by
# cmake -P from page.cmake, so that configuring needs neither node nor npm.
get_filename_component(work ${OUT} DIRECTORY)
file(MAKE_DIRECTORY ${work})

# quietly(NAME COMMAND…): runs COMMAND; its output goes to a log that is shown only if it fails
function(quietly name)
  set(log ${work}/${name}.log)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${WEB} RESULT_VARIABLE result OUTPUT_FILE ${log} ERROR_FILE ${log})
  if(NOT result EQUAL 0)
    file(READ ${log} output)
    message(FATAL_ERROR "npm ${name} failed in ${WEB}:\n${output}")
  endif()
endfunction()

set(names "")
if(PAGE)
  find_program(npm npm)
  find_program(node node)
  if(NOT npm OR NOT node)
    message(FATAL_ERROR "the page needs node (18 or newer) and npm: install nodejs and npm, or configure with -DPROSTM_PAGE=OFF")
  endif()
  # npm leaves its own lock file in the folder that it installs into
  if("${WEB}/package-lock.json" IS_NEWER_THAN "${WEB}/node_modules/.package-lock.json")
    quietly(install ${npm} ci)
    file(TOUCH ${WEB}/node_modules/.package-lock.json)
  endif()
  quietly(build ${npm} run build)
  file(GLOB_RECURSE names RELATIVE ${WEB}/dist ${WEB}/dist/*)
  list(SORT names)
endif()

set(type_html "text/html; charset=utf-8")
set(type_js "text/javascript; charset=utf-8")
set(type_css "text/css; charset=utf-8")
set(type_svg "image/svg+xml")

# .incbin makes the assembler read the bytes, at no cost for the compiler. ccache does not see them, so each file's hash is
# in the source: a page that changed is compiled again.
set(bytes "")
set(rows "")
set(count 0)
foreach(name IN LISTS names)
  string(REGEX REPLACE "^.*\\." "" ending ${name})
  if(NOT DEFINED type_${ending})
    message(FATAL_ERROR "the page's file ${name} has a media type unknown to cmake/build_page.cmake")
  endif()
  set(path "/${name}")
  if(name STREQUAL "index.html")
    set(path "/")
  endif()
  file(SHA256 ${WEB}/dist/${name} hash)
  string(APPEND bytes "asm(\"/* ${hash} */ .pushsection .rodata\\n.globl prostm_page_${count}, prostm_page_${count}_end\\n\"
    \".hidden prostm_page_${count}\\n.hidden prostm_page_${count}_end\\n\"
    \"prostm_page_${count}: .incbin \\\"${WEB}/dist/${name}\\\"\\n\"
    \"prostm_page_${count}_end: .byte 0\\n.popsection\\n\");
extern \"C\" const unsigned char prostm_page_${count}[], prostm_page_${count}_end[];\n")
  string(APPEND rows "      {\"${path}\", \"${type_${ending}}\", {prostm_page_${count}, prostm_page_${count}_end}},\n")
  math(EXPR count "${count} + 1")
endforeach()

if(rows STREQUAL "")
  set(body "  return {};")
else()
  set(body "  static const PageFile kFiles[] = {\n${rows}  };\n  return kFiles;")
endif()
file(WRITE ${OUT} "// Written by cmake/build_page.cmake.
#include \"prostm/viewer/page_files.hpp\"

${bytes}
namespace prostm {

std::span<const PageFile> page_files() {
${body}
}

}  // namespace prostm
")
