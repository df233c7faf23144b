# bash completion for gonio: commands, options, their values and the built-in materials.
# File names are left to bash. Installed as bash-completion/completions/gonio; to try it:
#   . completions/gonio.bash

# The program lists its commands and their options, so that none is missing here.
_gonio_commands()
{
    "${COMP_WORDS[0]}" --help 2>/dev/null | sed -n 's/^  \([a-z-]*\) .*/\1/p'
}

# Lines "-n --number N": the names of an option and, if it takes a value, what the help calls that.
_gonio_list_options()
{
    "${COMP_WORDS[0]}" "$1" --list-options 2>/dev/null
}

# What the help calls the value of an option of a command; nothing if it takes none.
_gonio_value_name()
{
    _gonio_list_options "$2" | sed -n "s/^\(.* \)*$1\( -[^ ]*\)* \([^- ].*\)\$/\3/p"
}

# Words for the value of an option of a command; fails if there is nothing to say (a file, or no option).
_gonio_values()
{
    [[ $1 == -* ]] || return 1
    case $1 in
        --grid)     echo "sectored bivariate full" ;;
        --channels) echo "joint separate" ;;
        --metric)   echo "e6 cube-root log-relative" ;;
        --only)     echo "fig2a fig2b fig3a fig3b fig4 fig5 fig6 fig7" ;;
        --mapping)  echo "log relative" ;;
        --method)   [[ $2 == reconstruct ]] && echo "posterior least-squares ridge" ||
                        echo "expected-error condition random matusik nielsen frost" ;;
        --directions) echo "planned next random in-plane two-incidences repeated condition matusik nielsen frost" ;;
        --methods)  echo "posterior interpolation lambert-ggx external" ;;
        --environment|-e) echo "studio sky furnace" ;;
        --light)    echo "directional point" ;;
        --instrument) echo "in-plane two-arms four-axis" ;;
        --start)    echo "random qr volume" ;;
        --illuminant) echo "E D65 A" ;;
        --format)   echo "merl rgl table klems zemax csv" ;;
        *)
            case $(_gonio_value_name "$1" "$2") in
                ''|FILE|DIR|DIR'|'BASIS|NUMBER'|'FILE|OUT|BASIS|PLAN|READINGS|PAGE) return 1 ;;
                *) echo "" ;; # numbers, names and texts
            esac ;;
    esac
}

_gonio_atlas()
{
    "${COMP_WORDS[0]}" info atlas: 2>/dev/null | cut -d ' ' -f 1
}

_gonio()
{
    local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}
    local command=${COMP_WORDS[1]} values
    COMPREPLY=()

    if [[ $COMP_CWORD -eq 1 ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$(_gonio_commands) help --help --version" -- "$current")
        return
    fi

    # bash takes --grid=full and atlas:gold-leaf apart at = and :.
    if [[ $current == "=" ]]; then
        current=
    elif [[ $previous == "=" ]]; then
        previous=${COMP_WORDS[COMP_CWORD - 2]}
    elif [[ $current == ":" && $previous == atlas ]]; then
        mapfile -t COMPREPLY < <(_gonio_atlas | cut -c 7-)
        return
    elif [[ $previous == ":" && ${COMP_WORDS[COMP_CWORD - 2]} == atlas ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$(_gonio_atlas | cut -c 7-)" -- "$current")
        return
    fi

    if values=$(_gonio_values "$previous" "$command"); then
        mapfile -t COMPREPLY < <(compgen -W "$values" -- "$current")
        compopt +o default +o bashdefault 2>/dev/null
    elif [[ $command == check && $current != -* ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$(_gonio_values --instrument)" -- "$current"; compgen -f -- "$current")
    elif [[ $current == -* ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$(_gonio_list_options "$command" | grep -oE -- '(^| )--?[a-zA-Z][a-z-]*')" -- "$current")
    elif [[ $current == atlas:* ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$(_gonio_atlas)" -- "$current")
    elif [[ -n $current && atlas: == "$current"* && $previous != -o && $previous != --output ]]; then
        mapfile -t COMPREPLY < <(compgen -f -- "$current")
        [[ ${#COMPREPLY[@]} -eq 0 ]] || compopt -o filenames 2>/dev/null
        COMPREPLY+=(atlas:)
        compopt -o nospace 2>/dev/null
    fi
}

complete -o default -o bashdefault -F _gonio gonio
