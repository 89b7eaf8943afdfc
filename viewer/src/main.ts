// The page of a report: its data stand behind it.

import { load } from './data';
import { h } from './dom';
import { Page, entryOf } from './page';

async function start(): Promise<void> {
  const root = document.getElementById('page')!;
  try {
    const data = await load();
    const page = new Page(data, data.studies.map(entryOf), root);
    window.grashof = page.face();
  } catch (error) {
    root.append(h('p', { class: 'failed', role: 'alert' }, `The data of this page cannot be read: ${error instanceof Error ? error.message : String(error)}. It needs a browser of 2023 or later.`));
  }
}

void start();
