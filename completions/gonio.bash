# bash completion for gonio: commands, options, their values and the built-in materials.
# File names are left to bash. Installed as bash-completion/completions/gonio; to try it:
#   . completions/gonio.bash

_gonio_options()
{
    local common="--threads --quiet --help -q -h"
    case $1 in
        info)        echo "--json $common" ;;
        convert)     echo "$common" ;;
        learn)       echo "--output --components --grid --channels --mixtures --seed --mapping --no-mean --without" \
                          "--json -o -K $common" ;;
        plan)        echo "--output --number --target-error --candidates --metric --components --method --start" \
                          "--restarts --seed --phi-d --history --json -o -n -K $common" ;;
        next)        echo "--output --number --target-error --candidates --metric --noise --floor --saturation --no-checks" \
                          "--json -o -n $common" ;;
        measure)     echo "--output --noise --floor --outliers --seed -o $common" ;;
        reconstruct) echo "--output --components --method --eta --noise --floor --saturation --deviation --predict-at --no-checks" \
                          "--all-channels --average-repeats --negative-to-zero --other-basis --json -o -K $common" ;;
        render)      echo "--output --mesh --environment --turn --show-environment --repair --light --light-at" \
                          "--view --fov --size --samples --seed --key --compare --columns --labels" \
                          "--differences -o -m -e $common" ;;
        compare)     echo "--verbose --render --leave-out --json -v $common" ;;
        reproduce)   echo "--output --quick --only --splits --seed --skip-bad -o $common" ;;
        report)      echo "--output --readings --deviation -o $common" ;;
        demo)        echo "--output -o $common" ;;
    esac
}

# Words for the value of an option of a command; fails if there is nothing to say (a file, or no option).
_gonio_values()
{
    case $1 in
        --grid)     echo "sectored bivariate full" ;;
        --channels) echo "joint separate" ;;
        --metric)   echo "e6 cube-root log-relative" ;;
        --only)     echo "fig2a fig2b fig3a fig3b fig4 fig5 fig6 fig7" ;;
        --mapping)  echo "log relative" ;;
        --method)   [[ $2 == reconstruct ]] && echo "posterior least-squares ridge" ||
                        echo "expected-error condition random matusik nielsen frost" ;;
        --environment|-e) echo "studio sky furnace" ;;
        --light)    echo "directional point" ;;
        --start)    echo "random qr volume" ;;
        --components|--number|--restarts|--seed|--phi-d|--eta|--noise|--floor|--threads|-K|-n|\
        --mixtures|--target-error|--outliers|--saturation|\
        --turn|--without|--light-at|--view|--fov|--size|--samples|--key|--columns|--labels) echo "" ;;
        *)          return 1 ;;
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
        mapfile -t COMPREPLY < <(compgen -W "info convert learn plan next measure reconstruct compare \
                                             report render reproduce demo help --help --version" -- "$current")
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
    elif [[ $current == -* ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$(_gonio_options "$command")" -- "$current")
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
