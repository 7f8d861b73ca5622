# What Doxygen needs and our headers do not say: that the comment after `#pragma once`, with a blank line below it, is the
# file's; and that <name> in a comment is no HTML.
/^\/\/\// { gsub(/<[a-z_]+>/, "\\\\&") }
/^#pragma once/ { print; at_top = 1; next }
at_top == 1 && /^$/ { print; next }
at_top && /^\/\/\// { block = block $0 "\n"; at_top = 2; next }
at_top == 2 { printf "%s%s", /^$/ ? "/// \\file\n" : "", block; block = ""; at_top = 0 }
{ at_top = 0; print }
