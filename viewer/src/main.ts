// The page of a report: its data stand behind it.

import { load } from './data';
import { h } from './dom';
import { Page, entryOf } from './page';
import type { Study } from './types';

async function start(): Promise<void> {
  const root = document.getElementById('page')!;
  try {
    const data = await load();
    const { studies } = data;
    const page = new Page({ ...data, studies: studies.filter((study): study is Study => !('faults' in study)) }, studies.map(entryOf), root);
    window.grashof = page.face();
  } catch (error) {
    root.append(h('p', { class: 'failed', role: 'alert' }, `The data of this page cannot be read: ${error instanceof Error ? error.message : String(error)}. It needs a browser of 2023 or later.`));
  }
}

void start();
