# Sourced by the scripts, from the root of the project.

# safe.directory: a container's root may look at a checkout that belongs to somebody else.
project_git() { git -c safe.directory='*' "$@"; }

project_git rev-parse --is-inside-work-tree >/dev/null 2>&1 || {
    echo "${0##*/}: error: git does not know this folder; clone the project instead of copying its files" >&2
    exit 1
}

# The files of the project, one a line, as patterns of git select them. New files count before they are committed, so
# that a check says what it will say afterwards.
project_files() {
    project_git ls-files --cached --others --exclude-standard -- "$@" | while IFS= read -r file; do
        [[ ! -e $file ]] || printf '%s\n' "$file"
    done
}
