" Vim syntax file
" Language: dosm robot missions, edition 1

if exists('b:current_syntax')
  finish
endif

let s:cpo_save = &cpo
set cpo&vim

syn case match
syn sync fromstart

" ---- Names ---------------------------------------------------------------------------------------------

" Before all words, so that these win. A ball's `norm` may follow a name.
syn match dosmIdentifier "\<\h\w*\>" nextgroup=dosmUncertainty,dosmNorm skipwhite

" ---- Words that are reserved everywhere ----------------------------------------------------------------

" words(declarations -dynamics -connectivity -workspace -minimize -goal -define -mission -param -let -robot)
syn keyword dosmDeclaration nextgroup=dosmName skipwhite
  \ dosm region obstacle opaque jammer base team separation horizon

syn keyword dosmDeclaration mission nextgroup=dosmName skipwhite
syn keyword dosmDeclaration param let nextgroup=dosmConstantName skipwhite
syn keyword dosmDeclaration goal define nextgroup=dosmFormulaName skipwhite
syn keyword dosmDeclaration robot nextgroup=dosmRobotName skipwhite
syn keyword dosmDeclaration dynamics nextgroup=dosmModelName skipwhite skipempty
syn keyword dosmDeclaration connectivity nextgroup=dosmOff,dosmBlock skipwhite skipempty
syn keyword dosmDeclaration workspace nextgroup=dosmShape skipwhite skipempty
syn keyword dosmDeclaration minimize nextgroup=dosmObjective skipwhite

syn match dosmName "\<\h\w*\>" contained
syn match dosmConstantName "\<\h\w*\>" contained
syn match dosmFormulaName "\<\h\w*\>" contained
syn match dosmRobotName "\<\h\w*\>" contained nextgroup=dosmRobotIndices,dosmRobotColon skipwhite
syn region dosmRobotIndices matchgroup=dosmBracket start="\[" end="\]" contained transparent
  \ nextgroup=dosmRobotColon skipwhite
syn match dosmRobotColon ":" contained nextgroup=dosmModel skipwhite
syn match dosmModel "\<\h\w*\>" contained
syn match dosmModelName "\<\h\w*\>" contained nextgroup=dosmBlock skipwhite skipempty

" words(prepositions)
syn keyword dosmPreposition
  \ in at

" words(temporal, temporal_letters)
syn keyword dosmTemporal
  \ always eventually next until release weak strong X F G U R W M

" words(logic -or)
syn keyword dosmLogic
  \ and not

" It joins shapes, too.
syn keyword dosmLogic or nextgroup=dosmShape skipwhite skipempty

" words(quantifiers)
syn keyword dosmQuantifier
  \ forall exists count

" words(sets)
syn keyword dosmConstant
  \ all

" words(truths)
syn keyword dosmBoolean
  \ true false

" words(functions)
syn keyword dosmFunction
  \ sqrt sin cos min max abs floor mod

" words(constants)
syn keyword dosmConstant
  \ pi

" ---- Words in their places -----------------------------------------------------------------------------

" words(shapes -where)
syn keyword dosmShape contained
  \ box ball disc polygon hull

syn keyword dosmShape contained where nextgroup=dosmHalfSpaces skipwhite skipempty

" Behind a point; `norm` behind a number or a name as well.
" words(shape_parts -norm)
syn keyword dosmShapePart contained
  \ radius

syn keyword dosmShapePart contained norm
syn keyword dosmNorm contained norm

" words(connectivity_off)
syn keyword dosmOff contained
  \ none

" words(objectives)
syn keyword dosmObjective contained
  \ effort length

" words(dynamics_items -bound, connectivity_items)
syn keyword dosmItem contained
  \ step state input position continuous integrator disturbance rejection mode hops range redundancy
  \ every

syn keyword dosmItem contained bound nextgroup=dosmShape skipwhite skipempty

" words(dynamics_parts)
syn keyword dosmItem contained
  \ when

" words(matrices)
syn keyword dosmMatrix contained
  \ A B c

" words(coordinates)
syn keyword dosmCoordinate contained
  \ x y z

" ---- Numbers and units ---------------------------------------------------------------------------------

syn match dosmNumber "\<\d\+\%(\.\d\+\)\=\%([eE][+-]\=\d\+\)\="
  \ nextgroup=dosmUnit,dosmUnitOne,dosmUncertainty,dosmNorm skipwhite
syn match dosmUnitOne "\<1\ze/\a" contained nextgroup=dosmUnitSign
syn match dosmUnitOne "\<1\>\%(\.\)\@!" contained

" words(units)
syn keyword dosmUnit contained nextgroup=dosmUnitPower,dosmUnitSign,dosmShapePart,dosmUncertainty skipwhite
  \ m cm mm km s ms min rad deg kg g N

syn match dosmUnitPower "\^-\=\d\+" contained nextgroup=dosmUnitSign,dosmShapePart,dosmUncertainty skipwhite
syn match dosmUnitSign "[*/]\ze\a" contained nextgroup=dosmUnit

" ---- Signs ---------------------------------------------------------------------------------------------

syn match dosmOperator "<->\|->\|||\|&&\|!=\|!\|<=\|>=\|<>\|[-+*/^<>]\|\.\.\|\[\]"
syn match dosmOperator "=" nextgroup=dosmShape skipwhite skipempty
syn match dosmUncertainty "+/-\|±" contained
syn match dosmUncertainty "+/-\|±"
syn match dosmDelimiter "[,;]"
syn match dosmDelimiter ":" nextgroup=dosmUnitOne,dosmUnit skipwhite
syn match dosmBracket "[(\[]\%(\]\)\@!"
syn match dosmBracket ")" nextgroup=dosmUnit,dosmShapePart skipwhite skipempty
syn match dosmBracket "\]" nextgroup=dosmUnit,dosmNorm skipwhite

" ---- Comments ------------------------------------------------------------------------------------------

" Behind all signs, so that these win.
syn keyword dosmTodo contained TODO FIXME XXX NOTE
syn match dosmComment "//.*$" contains=dosmTodo,@Spell
syn match dosmDocComment "///\%([^/].*\)\=$" contains=dosmTodo,@Spell
syn match dosmDocComment "//!.*$" contains=dosmTodo,@Spell
syn region dosmComment start="/\*" end="\*/" contains=dosmComment,dosmTodo,@Spell fold extend

" ---- Blocks --------------------------------------------------------------------------------------------

syn cluster dosmCode contains=dosmComment,dosmDocComment,dosmIdentifier,dosmDeclaration,dosmPreposition,
  \dosmTemporal,dosmLogic,dosmQuantifier,dosmConstant,dosmBoolean,dosmFunction,dosmNumber,dosmOperator,
  \dosmUncertainty,dosmDelimiter,dosmBracket
syn region dosmBlock matchgroup=dosmBracket start="{" end="}" contained fold
  \ contains=@dosmCode,dosmItem,dosmMatrix,dosmBraces
" Modes have braces of their own in a block; elsewhere states have.
syn region dosmBraces matchgroup=dosmBracket start="{" end="}" fold contains=@dosmCode,dosmMatrix,dosmBraces
syn region dosmHalfSpaces matchgroup=dosmBracket start="{" end="}" contained fold
  \ contains=@dosmCode,dosmCoordinate

" ---- Colours -------------------------------------------------------------------------------------------

hi def link dosmTodo Todo
hi def link dosmComment Comment
hi def link dosmDocComment SpecialComment
hi def link dosmDeclaration Keyword
hi def link dosmItem Keyword
hi def link dosmShapePart Keyword
hi def link dosmNorm Keyword
hi def link dosmOff Keyword
hi def link dosmShape Structure
hi def link dosmPreposition Operator
hi def link dosmTemporal Statement
hi def link dosmLogic Statement
hi def link dosmQuantifier Statement
hi def link dosmConstant Constant
hi def link dosmObjective Constant
hi def link dosmBoolean Boolean
hi def link dosmFunction Function
hi def link dosmMatrix Special
hi def link dosmCoordinate Special
hi def link dosmNumber Number
hi def link dosmUnit Type
hi def link dosmUnitOne Type
hi def link dosmUnitPower Type
hi def link dosmUnitSign Type
hi def link dosmOperator Operator
hi def link dosmUncertainty Operator
hi def link dosmDelimiter Delimiter
hi def link dosmBracket Delimiter
hi def link dosmName Identifier
hi def link dosmRobotName Identifier
hi def link dosmConstantName Constant
hi def link dosmFormulaName Function
hi def link dosmModelName Type
hi def link dosmModel Type

let b:current_syntax = 'dosm'

let &cpo = s:cpo_save
unlet s:cpo_save
