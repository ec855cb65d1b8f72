"""The formula of the current event with this path's own numbers; a factor leads to the event it came from."""

from viewer.equation import formulas
from viewer.panels.panel import Panel

TEMPLATE = """
<div class="formula" data-testid="equation" :aria-label="w.equation"
  @click="$event.target.closest('[data-step]') && trigger('event', [$event.target.closest('[data-step]').dataset.step])">
  <div class="symbolic" data-testid="equation-symbolic" v-html="equation.symbolic"></div>
  <div v-for="row in equation.rows" :key="row.channel" class="channel" :class="row.channel">
    <b>{{ row.channel }}</b><div class="scroll" :data-testid="'equation-' + row.channel" v-html="row.math"></div></div>
  <p v-if="equation.result" class="result">{{ w.result }}
    <output data-testid="equation-result">{{ equation.result }}</output></p>
  <p v-if="equation.differs" class="warning" role="alert" data-testid="equation-differs">{{ w.differs }} {{ equation.differs }}</p>
  <table v-if="equation.legend.length" class="legend" :aria-label="w.symbols"><tbody>
    <tr v-for="row in equation.legend" :key="row.field" :data-testid="'factor-' + row.field" :data-exact="JSON.stringify(row.exact)"><th scope="row" v-html="row.symbol"></th>
      <td>{{ row.meaning }} <button v-if="row.source" class="plain source" :data-step="row.came" :data-testid="'source-' + row.field">← {{ row.source }}</button></td>
      <td class="number">{{ row.value }}</td></tr></tbody></table>
  <div v-if="equation.weight" class="weight" data-testid="equation-weight">
    <h2>{{ w.weight }}</h2><div class="scroll" v-html="equation.weight.math"></div><p>{{ equation.weight.note }}</p></div>
</div>
"""


def show(session, say):
    """The formulas of the event, ready as MathML."""
    return formulas(session.path, session.cursor.event, session.settings, say)


PANEL = Panel("equation", "tab", "event", 20, TEMPLATE, show)
